"""The last minutes of live topics, and their recording to files."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec

from webviz.api.errors import Error
from webviz.api.roles import Role
from webviz.api.status import Level, Status
from webviz.data.names import new_path
from webviz.data.recordings import RecordingError
from webviz.data.recordings.folder_writing import RecordingFolder
from webviz.data.words import counted, joined
from webviz.engine.commands import FileCommand, Sender
from webviz.engine.feature import Feature, command, store
from webviz.engine.forms import sendable
from webviz.engine.parts.part import PartContext
from webviz.engine.parts.settings import SettingsPart
from webviz.engine.requests import Job
from webviz.engine.store import PageStore
from webviz.files.config.model import MemorySettings
from webviz.sources.recording import Recorder, library
from webviz.sources.recording.memory import MEMORY_OFF, MemoryHistory

MEGABYTE = 1_000_000
NAMED = 4
"""Topics that are named."""
FROM_BAG = "A bag is a recording already. Copy its files."


class MemoryState(msgspec.Struct, frozen=True):
    """The memory of live topics.

    Args:
        seconds: since the oldest message.
        size: bytes of all messages.
        is_full: whether younger messages than wanted were forgotten for their size.
        pinned: topics whose latched messages are kept although they are older.
        held_s: seconds that people look back on; None live.
        cut: topics of large messages that reach back less than others, and for how many seconds;
            None if there are none.
    """

    seconds: float
    size: int
    is_full: bool = False
    pinned: tuple[str, ...] = ()
    held_s: float | None = None
    cut: tuple[tuple[str, ...], float] | None = None


class RecordingState(msgspec.Struct, frozen=True, kw_only=True):
    """A recording of live topics that goes on.

    Args:
        path: of its folder.
        seconds: since it began.
        messages: that were written.
        size: bytes of its files.
        dropped: messages that the disk was too slow for.
    """

    path: Path
    seconds: float
    messages: int
    size: int
    dropped: int


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
        past_s: seconds that people look back on, which are saved while they do; None live.
    """

    remembered: tuple[int, int]
    is_remembering: bool
    about: str
    recording: RunningRecording | None
    past_s: int | None = None


class RecordingFeature(Feature):
    """Remembers what arrives, and writes it to files; nothing of a bag."""

    name = "Recording"
    module = "recording.js"

    def __init__(self, context: PartContext) -> None:
        super().__init__(context)
        self._memory = context.player.memory
        self._recorder: Recorder | None = None
        self._problem = ""
        if (memory := self._memory) is not None:
            context.player.inbox.read_along(lambda: memory.recent.put)

    @property
    def _bounds(self) -> MemorySettings:
        return self.context.get(SettingsPart).settings.memory

    def keep_up(self, commanded: bool) -> None:
        """Follow the settings, and notice that a recording has ended on its own."""
        if self._memory is not None:
            bounds, recent = self._bounds, self._memory.recent
            recent.seconds = bounds.seconds
            recent.max_bytes = round(bounds.size_mb * MEGABYTE)
            self._memory.recorded_channels.look()
        if self._recorder is not None and self._recorder.problem:
            self._problem = joined(self._recorder.problem, "The recording has ended.")
            self._end(self._recorder)

    def state(self) -> Mapping[str, Any]:
        """Return the memory and the recording."""
        memory = self._memory and self._remembered(self._memory)
        return {"memory": memory, "recording": self._recorded()}

    def _remembered(self, memory: MemoryHistory) -> MemoryState:
        seconds, size = memory.recent.size()
        held_s = memory.held_s if memory.is_held else None
        recent = memory.recent
        return MemoryState(seconds, size, recent.is_full, recent.pinned(), held_s, recent.cut())

    def _recorded(self) -> RecordingState | None:
        recorder = self._recorder
        return recorder and RecordingState(
            path=recorder.path,
            seconds=recorder.seconds,
            messages=recorder.messages,
            size=recorder.bytes_written,
            dropped=recorder.dropped,
        )

    @store()
    def recording(self, argument: str) -> RecordingStore | None:
        """Return the memory and the recording, None for a bag."""
        memory = self._memory and self._remembered(self._memory)
        return recording_store(memory, self._recorded(), self._bounds)

    def statuses(self) -> Mapping[str, Status]:
        """Messages that are missing in the recording."""
        if self._problem:
            return {"Recording": Status(Level.ERROR, self._problem)}
        if self._recorder is not None and self._recorder.dropped:
            dropped = counted(self._recorder.dropped, "message")
            text = f"{dropped} dropped, because the disk is too slow. Show fewer topics."
            return {"Recording": Status(Level.WARN, text)}
        return {}

    def close(self) -> None:
        """Complete the recording."""
        self.context.player.inbox.readers = ()
        if self._recorder is not None:
            self._recorder.close()

    def _end(self, recorder: Recorder) -> None:
        """Let a recorder read no more."""
        self._recorder = None
        self.context.player.inbox.forget(recorder.put)

    @command(Role.OWNER, FileCommand)
    def start_recording(self, sender: Sender, path: str = "") -> Job[RecordingFolder]:
        """Record all topics that are subscribed to, until `StopRecording`.

        Args:
            path: of a new folder; "" is one in the working folder, named by date and time.
                Browsers cannot choose it.
        """
        memory, place = self._memory_history(), _new_path(path, sender)
        if self._recorder is not None:
            raise Error(f"{self._recorder.path.name} is being recorded already. Stop it first.")

        def then(folder: RecordingFolder) -> str:
            now_ns = memory.live.now_ns()
            latched = memory.recent.last(0.0).latched
            past = [(topic, replace(raw, received_ns=now_ns)) for topic, raw in latched]
            self._recorder = recorder = Recorder(folder, memory.recorded_channels, past)
            self._problem = ""
            self.context.player.inbox.read_along(lambda: recorder.put)
            return f"Recording to {place.name}."

        return Job(lambda: new_folder(place), then)

    @command(Role.OWNER, FileCommand)
    def stop_recording(self, sender: Sender) -> Job[None]:
        """Complete the recording."""
        recorder = self._recorder
        if recorder is None:
            raise Error("Nothing is being recorded.")
        self._end(recorder)

        def then(_: None) -> str:
            if recorder.problem:
                raise Error(recorder.problem)
            text = f"Recorded {counted(recorder.messages, 'message')} to {recorder.path.name}."
            self.context.outputs.add(recorder.path, "recording", text, sender)
            return text

        return Job(recorder.close, then)

    @command(Role.OWNER, FileCommand)
    def save_memory(
        self, sender: Sender, seconds: float | None = None, path: str = ""
    ) -> Job[Recorder]:
        """Write the last seconds of what was subscribed to, with the latched messages before them.

        Args:
            seconds: until now, as far as they are remembered; None is everything, and while people
                look back also what has been forgotten since.
            path: as that of `StartRecording`.
        """
        memory, place = self._memory_history(), _new_path(path, sender)
        span_s = math.inf if seconds is None else seconds
        if not span_s > 0:
            raise Error(f"{span_s:g} s is not a valid time span. Give a positive number.")
        is_held = memory.is_held and seconds is None
        past = memory.recent.last(span_s)
        entries = memory.entries() if is_held else past.whole
        if not (past.messages or is_held):
            raise Error(
                "No messages are kept in memory. Show a topic, or raise memory.seconds in the "
                "config."
            )

        def work() -> Recorder:
            recorder = Recorder(new_folder(place), memory.recorded_channels, entries)
            recorder.close()
            return recorder

        def then(recorder: Recorder) -> str:
            if recorder.problem:
                raise Error(recorder.problem)
            (_, first), (_, last) = (
                entries[0],
                entries[-1],
            )  # latched ones have the time of the first
            span = f"{(last.received_ns - first.received_ns) / 1e9:.0f} s"
            what = f"all {span} of the timeline" if is_held else f"the last {span}"
            text = f"Saved {what} to {recorder.path.name}."
            self.context.outputs.add(recorder.path, "recording", text, sender)
            return text

        return Job(work, then)

    def _memory_history(self) -> MemoryHistory:
        if self._memory is None:
            raise Error(FROM_BAG)
        return self._memory


def _new_path(path: str, sender: Sender) -> Path:
    if path and sender.browser is not None:
        raise Error("A page cannot choose the folder of a recording.")
    return Path(path) if path else new_path("webviz")


def new_folder(path: Path) -> RecordingFolder:
    """Return a folder to record to; blocks.

    Raises:
        Error: it cannot be written.
    """
    try:
        return RecordingFolder(path.absolute(), library())
    except RecordingError as error:
        raise Error(str(error)) from error


def recording_store(
    memory: MemoryState | None, recording: RecordingState | None, bounds: MemorySettings
) -> RecordingStore | None:
    """Return what pages show of a memory and a recording, None without a memory."""
    if memory is None:
        return None
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
        is_remembering=bounds.seconds > 0 and bounds.size_mb > 0,
        about=str(sendable(_about(memory, bounds))),
        recording=running,
        past_s=None if memory.held_s is None else int(memory.held_s),
    )


def _about(memory: MemoryState, limits: MemorySettings) -> str:
    """Sentences on the memory: its bounds, which of them is reached, and what is kept beyond."""
    if not (limits.seconds and limits.size_mb):
        return MEMORY_OFF
    bound = f"the last {limits.seconds:g} s of the displayed topics, up to {limits.size_mb:g} MB"
    sentences = [f"Remembers {bound}."]
    if memory.cut is not None:
        topics, seconds = memory.cut
        sentences.append(
            f"Of large messages ({_named(topics)}) it holds the last {seconds:.0f} s, as more do "
            "not fit: raise memory.megabytes."
        )
    elif memory.is_full:
        sentences.append("Older messages are dropped already: raise memory.megabytes.")
    if pinned := memory.pinned:
        sentences.append(
            f"Older latched messages and last transforms are kept of {_named(pinned)}."
        )
    return " ".join(sentences)


def _named(topics: Sequence[str]) -> str:
    return ", ".join(topics[:NAMED]) + (" …" if len(topics) > NAMED else "")
