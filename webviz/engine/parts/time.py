"""The time that is shown, as in RViz's Time panel."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Any

from webviz.api.roles import Role
from webviz.api.status import Level, Status
from webviz.data.words import counted
from webviz.engine.parts.declaring import command, store
from webviz.engine.parts.part import Core, Part
from webviz.engine.pipeline.clock_rate import ClockRateMeter, Rate
from webviz.engine.pipeline.ros_time import RosTime
from webviz.engine.state import PanelTimes
from webviz.engine.store import PageStore
from webviz.sources.player import Player


class ClockStore(PageStore, frozen=True):
    """The times, in seconds.

    Args:
        pace: ROS time, wall time of the same moment, and how fast ROS time runs from there.
        began: both times at the start or the last reset.
        is_known: whether there is a ROS time.
        is_paused, is_simulated: see `webviz.engine.state.PanelTimes`.
        hz: rate of /clock to two digits.
    """

    pace: tuple[float, float, float]
    began: tuple[float, float]
    is_known: bool
    is_paused: bool
    is_simulated: bool
    hz: float


class TimePart(Part):
    """ROS time, which can be paused and can start over.

    Args:
        core: shared by all parts.
        reset: discards the received data of all parts.
        player: plays the past, which is paused instead of the inbox unless topics are live.
    """

    name = "Time"

    def __init__(self, core: Core, reset: Callable[[], None], player: Player) -> None:
        super().__init__(core)
        self._player = player
        self._reset_all = reset
        self._paused_ns: int | None = None
        self._time_rate = ClockRateMeter()
        self._clock_rate = Rate()
        self._start()
        self.missed = 0
        """Number of messages dropped while paused."""
        self.ros = RosTime(core.clock)
        """Detects that time went back."""
        self.times = PanelTimes()
        """Both clocks, as of the last turn."""

    @property
    def is_paused(self) -> bool:
        """Return whether messages wait in the inbox."""
        return self._paused_ns is not None

    @property
    def shown_ns(self) -> int:
        """ROS time to show."""
        return self.core.now_ns if self._paused_ns is None else self._paused_ns

    def update(self) -> None:
        """Read both clocks."""
        ros_ns, wall_s = self.core.frames.now_ns, time.time()
        if not 0 < self._began_ns <= ros_ns:  # time may have gone back while paused
            self._began_ns = ros_ns
        messages = self.core.player.clock_messages()
        player = self._player
        is_paused = self.is_paused if player.is_live else not player.is_playing
        self.times = PanelTimes(
            ros_ns,
            ros_ns - self._began_ns,
            wall_s,
            wall_s - self._began_s,
            is_paused,
            self._time_rate.step(ros_ns, wall_s, is_paused),
            messages is not None,
            self._clock_rate.step(messages or 0, self.core.clock()),
        )

    @store()
    def clock(self, argument: str) -> ClockStore:
        """Return both clocks; changes only if one of them does not go on as before."""
        times = self.times
        clock_rate = times.clock_rate
        return ClockStore(
            pace=(clock_rate.ros_ns / 1e9, clock_rate.wall_s, clock_rate.rate),
            began=(
                round((times.ros_ns - times.ros_elapsed_ns) / 1e9, 3),
                round(times.wall_s - times.wall_elapsed_s, 3),
            ),
            is_known=times.ros_ns != 0,
            is_paused=times.is_paused,
            is_simulated=times.is_simulated,
            hz=float(f"{times.clock_hz:.2g}"),
        )

    def state(self) -> Mapping[str, Any]:
        """Return the time."""
        return {"clock": self.times}

    def statuses(self) -> Mapping[str, Status]:
        """Return whether time runs."""
        status = self.ros.status(self.core.offers)
        if self.is_paused and self.missed and not status:
            text = f"{counted(self.missed, 'message')} dropped while paused; the newest are kept."
            status = Status(Level.OK, text)
        return {"Time": status} if status else {}

    def reset(self) -> None:
        """Restart elapsed time."""
        self._start()

    def start_over(self) -> None:
        """Discard all received data, since another position is played from now on."""
        self._paused_ns = None
        self.core.buffer.forget()  # also static transforms that come later in the recording
        self._reset_all()
        self.ros.restart(self.core.player.now_ns())

    def _start(self) -> None:
        self._began_ns = 0  # set when ROS time is known
        self._began_s = time.time()

    @command(Role.OPERATOR, name="Reset")
    def reset_viewer(self) -> None:
        """Discard transforms and messages, as RViz's Reset does."""
        self._reset_all()

    @command(Role.OPERATOR)
    def pause(self, paused: bool = True) -> None:
        """Pause or resume; messages wait while paused."""
        player = self._player
        if player.is_live:
            self._paused_ns = self.core.frames.now_ns if paused else None
        elif paused:
            player.pause()
        else:
            player.play()
