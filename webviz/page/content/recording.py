"""The memory of live topics, and their recording."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from typing import Any

from webviz.engine.state import State
from webviz.files.config.model import MemorySettings
from webviz.page.content.forms import sendable
from webviz.sources.past_state import MemoryState
from webviz.sources.rewindable import MEMORY_OFF

SHOWN = 4
"""Topics that are named."""
MAX_SAVED = 50
"""Recordings that are listed."""


def recording(state: State, _: str) -> Mapping[str, Any]:
    """The memory and the recording, empty for a bag; in whole seconds and megabytes."""
    memory, recording = state.memory, state.recording
    if memory is None:
        return {}
    limits = state.settings.memory
    told: dict[str, Any] = {
        "remembered": [int(memory.seconds), memory.size // 1_000_000],
        "is_remembering": limits.seconds > 0 and limits.megabytes > 0,
        "about": sendable(_about(memory, limits)),
        "recording": None,
    }
    if recording is not None:
        told["recording"] = {
            "name": sendable(recording.path.name),
            "seconds": int(recording.seconds),
            "megabytes": round(recording.size / 1e6, 1),
            "dropped": recording.dropped,
        }
    return told


def black_box(state: State, _: str) -> Mapping[str, Any]:
    """Recordings that rules made, the newest first: name, megabytes and the command to open it."""
    box = state.black_box
    if box is None or not (box.saved or state.settings.watch):
        return {}
    return {
        "saving": sendable(box.saving),
        "saved": [
            [
                sendable(each.path.name),
                round(each.size / 1e6, 1),
                sendable(f"webviz --bag {shlex.quote(str(each.path))}"),
            ]
            for each in box.saved[:MAX_SAVED]
        ],
    }


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
        sentences.append(f"Older latched messages are kept of {names}.")
    return " ".join(sentences)
