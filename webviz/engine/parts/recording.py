"""The last minutes of live topics, and their recording to files."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from webviz.api.errors import Error
from webviz.api.status import Level, Status
from webviz.data.names import new_path
from webviz.data.recordings import RecordingError
from webviz.data.recordings.folder_writing import RecordingFolder
from webviz.data.words import counted, joined
from webviz.engine.commands import Command, SaveMemory, Sender, StartRecording, StopRecording
from webviz.engine.commands.requests import Job
from webviz.engine.parts.part import Core, Handler, Part
from webviz.engine.parts.settings import SettingsPart
from webviz.sources.past_state import MemoryState, RecordingState
from webviz.sources.player import Player
from webviz.sources.recording import Recorder, library
from webviz.sources.recording.memory import MemoryHistory

MEGABYTE = 1_000_000
FROM_BAG = "A bag is a recording already. Copy its files."


class RecordingPart(Part):
    """Remembers what arrives, and writes it to files.

    Args:
        core: shared by all parts.
        settings: bound what is remembered.
        player: has the memory; none of a bag, which is neither remembered nor recorded.
    """

    name = "Recording"

    def __init__(self, core: Core, settings: SettingsPart, player: Player) -> None:
        super().__init__(core)
        self._settings = settings
        self._player = player
        self._memory = player.memory
        self._recorder: Recorder | None = None
        self._problem = ""
        if (memory := self._memory) is not None:
            player.inbox.read_along(lambda: memory.recent.put)

    @property
    def handles(self) -> Mapping[type[Command], Handler]:
        """The handler of each command."""
        return {
            StartRecording: self._start,
            StopRecording: self._stop,
            SaveMemory: self._save,
        }

    def keep_up(self, commanded: bool) -> None:
        """Follow the settings, and notice that a recording has ended by itself."""
        if self._memory is not None:
            bounds, recent = self._settings.settings.memory, self._memory.recent
            recent.seconds = bounds.seconds
            recent.max_bytes = round(bounds.megabytes * MEGABYTE)
            self._memory.recorded_channels.look()
        if self._recorder is not None and self._recorder.problem:
            self._problem = joined(self._recorder.problem, "The recording has ended.")
            self._end(self._recorder)

    def state(self) -> Mapping[str, Any]:
        """Return the memory and the recording."""
        if self._memory is None:
            return {"memory": None, "recording": None}
        recent = self._memory.recent
        seconds, size = recent.size()
        recorder = self._recorder
        recording = recorder and RecordingState(
            path=recorder.path,
            seconds=recorder.seconds,
            messages=recorder.messages,
            size=recorder.bytes_written,
            dropped=recorder.dropped,
        )
        remembered = MemoryState(seconds, size, recent.is_full, recent.pinned())
        return {"memory": remembered, "recording": recording}

    def statuses(self) -> Mapping[str, Status]:
        """Messages that are missing in the recording."""
        if self._problem:
            return {"Recording": Status(Level.ERROR, self._problem)}
        if self._recorder is not None and self._recorder.dropped:
            lost = counted(self._recorder.dropped, "message")
            text = f"{lost} dropped, because the disk is too slow. Show fewer topics."
            return {"Recording": Status(Level.WARN, text)}
        return {}

    def close(self) -> None:
        """Complete the recording."""
        self._player.inbox.readers = ()
        if self._recorder is not None:
            self._recorder.close()

    def _end(self, recorder: Recorder) -> None:
        """Let a recorder read no more."""
        self._recorder = None
        self._player.inbox.forget(recorder.put)

    # Commands

    def _start(self, command: StartRecording, sender: Sender) -> Job[RecordingFolder]:
        memory, path = self._known(), self._new_path(command.path, sender)
        if self._recorder is not None:
            raise Error(f"{self._recorder.path.name} is being recorded already. Stop it first.")

        def then(folder: RecordingFolder) -> str:
            now_ns = memory.live.now_ns()
            latched = memory.recent.last(0.0).latched
            past = [(topic, replace(raw, received_ns=now_ns)) for topic, raw in latched]
            self._recorder = recorder = Recorder(folder, memory.recorded_channels, past)
            self._problem = ""
            self._player.inbox.read_along(lambda: recorder.put)
            return f"Recording to {path.name}."

        return Job(lambda: new_folder(path), then)

    def _stop(self, command: StopRecording, sender: Sender) -> Job[None]:
        recorder = self._recorder
        if recorder is None:
            raise Error("Nothing is being recorded.")
        self._end(recorder)

        def then(_: None) -> str:
            if recorder.problem:
                raise Error(recorder.problem)
            return f"Recorded {counted(recorder.messages, 'message')} to {recorder.path.name}."

        return Job(recorder.close, then)

    def _save(self, command: SaveMemory, sender: Sender) -> Job[Recorder]:
        memory, path = self._known(), self._new_path(command.path, sender)
        seconds = math.inf if command.seconds is None else command.seconds
        if not seconds > 0:
            raise Error(f"{seconds:g} s is not a valid time span. Give a positive number.")
        past = memory.recent.last(seconds)
        if not past.messages:
            raise Error(
                "No messages are kept in memory. Show a topic, or raise memory.seconds in the "
                "config."
            )

        def work() -> Recorder:
            recorder = Recorder(new_folder(path), memory.recorded_channels, past.whole)
            recorder.close()
            return recorder

        def then(recorder: Recorder) -> str:
            if recorder.problem:
                raise Error(recorder.problem)
            (_, first), (_, last) = past.messages[0], past.messages[-1]
            saved_s = (last.received_ns - first.received_ns) / 1e9
            return f"Saved the last {saved_s:.0f} s to {recorder.path.name}."

        return Job(work, then)

    def _known(self) -> MemoryHistory:
        if self._memory is None:
            raise Error(FROM_BAG)
        return self._memory

    def _new_path(self, path: str, sender: Sender) -> Path:
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
