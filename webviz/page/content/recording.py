"""The memory of live topics, and their recording."""

from __future__ import annotations

import shlex
from collections.abc import Sequence

import msgspec

from webviz.engine.state import State
from webviz.engine.store import PageStore
from webviz.files.config.model import MemorySettings
from webviz.page.content.forms import sendable
from webviz.sources.past_state import MemoryState
from webviz.sources.recording.memory import MEMORY_OFF

SHOWN = 4
"""Topics that are named."""
MAX_SAVED = 50
"""Recordings that are listed."""


class RunningRecording(msgspec.Struct, frozen=True):
    """The recording that goes on.

    Args:
        name: of its file.
        seconds, megabytes: so far.
        dropped: messages that are missing in it.
    """

    name: str
    seconds: int
    megabytes: float
    dropped: int


class RecordingStore(PageStore, frozen=True):
    """The memory of live topics and their recording.

    Args:
        remembered: seconds and megabytes of the memory.
        is_remembering: whether there is a memory.
        about: sentences on the memory.
        recording: None for none.
    """

    remembered: tuple[int, int]
    is_remembering: bool
    about: str
    recording: RunningRecording | None


def recording(state: State, _: str) -> RecordingStore | None:
    """Return the memory and the recording, None for a bag."""
    memory, recording = state.memory, state.recording
    if memory is None:
        return None
    limits = state.settings.memory
    running = None
    if recording is not None:
        running = RunningRecording(
            name=str(sendable(recording.path.name)),
            seconds=int(recording.seconds),
            megabytes=round(recording.size / 1e6, 1),
            dropped=recording.dropped,
        )
    return RecordingStore(
        remembered=(int(memory.seconds), memory.size // 1_000_000),
        is_remembering=limits.seconds > 0 and limits.megabytes > 0,
        about=str(sendable(_about(memory, limits))),
        recording=running,
    )


class BlackBoxStore(PageStore, frozen=True):
    """Recordings that rules made.

    Args:
        saving: cause of the one that goes on, "" for none.
        saved: the newest first: name, megabytes, path, and the command to open it elsewhere.
    """

    saving: str
    saved: Sequence[tuple[str, float, str, str]]


def black_box(state: State, _: str) -> BlackBoxStore | None:
    """Return recordings that rules made, None without any rule or recording."""
    box = state.black_box
    if box is None or not (box.saved or state.settings.watch):
        return None
    return BlackBoxStore(
        saving=str(sendable(box.saving)),
        saved=[
            (
                str(sendable(each.path.name)),
                round(each.size / 1e6, 1),
                str(sendable(str(each.path))),
                str(sendable(f"webviz --bag {shlex.quote(str(each.path))}")),
            )
            for each in box.saved[:MAX_SAVED]
        ],
    )


def _about(memory: MemoryState, limits: MemorySettings) -> str:
    """Sentences on the memory: its bounds, which of them is reached, and what is kept beyond."""
    if not (limits.seconds and limits.megabytes):
        return MEMORY_OFF
    bound = f"the last {limits.seconds:g} s of the displayed topics, up to {limits.megabytes:g} MB"
    sentences = [f"Remembers {bound}."]
    if memory.is_full:
        sentences.append("Older messages are dropped already: raise memory.megabytes.")
    if pinned := memory.pinned:
        names = ", ".join(pinned[:SHOWN]) + (" …" if len(pinned) > SHOWN else "")
        sentences.append(f"Older latched messages and last transforms are kept of {names}.")
    return " ".join(sentences)
