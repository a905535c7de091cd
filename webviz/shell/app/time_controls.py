"""The part of `webviz.Viewer` that is about time: bags, and recordings of live topics."""

from __future__ import annotations

import math
import os
import time
from abc import ABC, abstractmethod
from pathlib import Path
from typing import Any

from webviz import commands
from webviz.api.errors import Error
from webviz.commands import Pause
from webviz.data.names import new_path
from webviz.engine.commands import Command
from webviz.shell.app.arguments import absolute, number
from webviz.shell.pictures.times import At, position_ns, seconds_from_start
from webviz.sources.past_state import PlaybackState
from webviz.sources.recording.memory import MEMORY_OFF


class TimeControls(ABC):
    """Pauses, plays and records."""

    @abstractmethod
    def fact(self, name: str, otherwise: Any = None) -> Any:
        """Return one field of the state."""

    @abstractmethod
    def do(self, command: Command) -> str:
        """Run a command, wait for it, and return its message."""

    def pause(self) -> None:
        """Pause the page, or the bag; live messages wait meanwhile."""
        self.do(Pause(True))

    def resume(self) -> None:
        """Resume the page, or the bag."""
        self.do(Pause(False))

    # Recording

    def record(self, folder: str | os.PathLike[str] = "") -> Path:
        """Record all topics that are subscribed to, until `stop_recording`.

        Args:
            folder: a new one, by default in the working folder and named by date and time.

        Returns:
            The folder.

        Raises:
            Error: it cannot be written, a recording goes on, or a bag is played.
        """
        path = absolute(folder, "folder") if folder != "" else str(new_path("webviz"))
        self.do(commands.StartRecording(path))
        return Path(path)

    def stop_recording(self) -> None:
        """Complete the recording.

        Raises:
            Error: nothing is being recorded, or it could not be written.
        """
        self.do(commands.StopRecording())

    def save_last(self, seconds: float | None = None, folder: str | os.PathLike[str] = "") -> Path:
        """Write what is remembered, with the newest latched messages before it, to a new folder.

        Args:
            seconds: as far as they are remembered, None is everything; see `memory` in the config.
            folder: as in `record`.

        Returns:
            The folder.

        Raises:
            Error: nothing is remembered, or the folder cannot be written.
        """
        path = absolute(folder, "folder") if folder != "" else str(new_path("webviz"))
        self.do(commands.SaveMemory(None if seconds is None else number(seconds, "seconds"), path))
        return Path(path)

    # The past of live topics

    def rewind(self, seconds: float) -> None:
        """Show live topics as they were, paused; returns when the scene shows it.

        Args:
            seconds: before now, as far as they are remembered; see `memory` in the config.

        Raises:
            Error: nothing is remembered, or a bag is played.
        """
        seconds, playback = number(seconds, "seconds"), self._playback
        if playback.is_opened:
            raise Error("A recording is shown. Return to live first.")
        if playback.is_live is None:
            raise Error("A bag cannot return to live. Use `seek`.")
        self.do(commands.Seek((time.time_ns() - playback.start_ns) / 1e9 - seconds))

    def open_recording(self, path: str | os.PathLike[str]) -> None:
        """Play a recording in the place of live topics, until `return_to_live`.

        Args:
            path: a file or folder, as of `bag`.

        Raises:
            Error: it cannot be read, or the viewer was started with a bag.
        """
        self.do(commands.OpenRecording(absolute(path, "path")))

    def return_to_live(self) -> None:
        """Show live topics as they are."""
        self.do(commands.ReturnToLive())

    # Bags

    def play(self, rate: float | None = None) -> None:
        """Play the bag, or the past of live topics; at its end from the start.

        Args:
            rate: recorded seconds per second, 0.01 to 1000; infinity is as fast as possible, None
                is the previous rate, at first 1.

        Raises:
            Error: the rate is out of range, or topics are live and not rewound.
        """
        if rate is not None:
            rate = number(rate, "rate")
            self.do(commands.SetRate(0.0 if math.isinf(rate) and rate > 0 else rate or -1.0))
        self.do(commands.Play())

    def seek(self, at: At) -> None:
        """Show the bag at a time; returns when the scene shows it. A bag that plays plays on.

        Args:
            at: seconds from its start (seconds since 1970 if above 1e9), "start" or "end".

        Raises:
            Error: the time is outside of the bag, or nothing of live topics is remembered.
        """
        playback = self._playback
        name = ", ".join(playback.names)
        self.do(commands.Seek(seconds_from_start(position_ns(at, playback, name), playback)))

    @property
    def span(self) -> tuple[float, float]:
        """Times of the first and the last message of the bag, in seconds since 1970.

        Raises:
            Error: topics are live.
        """
        playback = self._playback
        return playback.start_ns / 1e9, playback.end_ns / 1e9

    @property
    def position(self) -> float:
        """The time of the bag that is shown, in seconds from its start.

        Raises:
            Error: topics are live.
        """
        return self._playback.position_s

    @property
    def _playback(self) -> PlaybackState:
        playback: PlaybackState | None = self.fact("playback")
        if playback is None:
            raise Error(MEMORY_OFF)
        return playback
