"""The time that is shown: RViz's panel "Time"."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Any

from webviz.api.status import Status
from webviz.engine.commands import Command, Pause, Reset, Sender
from webviz.engine.parts.part import Core, Handler, Part
from webviz.engine.pipeline.pace import PaceMeter, Rate
from webviz.engine.pipeline.ros_time import RosTime
from webviz.engine.state import Clock


class TimePart(Part):
    """ROS time: it may stand still on the page, and it may start over.

    Args:
        core: what all parts share.
        reset: lets all parts forget what they received.
    """

    name = "Time"

    def __init__(self, core: Core, reset: Callable[[], None]) -> None:
        super().__init__(core)
        self._reset_all = reset
        self._paused_ns: int | None = None
        self._pace = PaceMeter()
        self._clock_rate = Rate()
        self._start()
        self.ros = RosTime(core.clock)
        """Whether it started over."""

    @property
    def handles(self) -> Mapping[type[Command], Handler]:
        """What does each of its commands."""
        return {Reset: self._reset, Pause: self._pause}

    @property
    def is_paused(self) -> bool:
        """Whether somebody lets it stand still."""
        return self._paused_ns is not None

    @property
    def shown_ns(self) -> int:
        """ROS time to show."""
        return self.core.now_ns if self._paused_ns is None else self._paused_ns

    def state(self) -> Mapping[str, Any]:
        """Both clocks."""
        ros_ns, wall_s = self.core.frames.now_ns, time.time()
        self._began_ns = self._began_ns or ros_ns
        messages = self.core.source.clock_messages()
        clock = Clock(
            ros_ns,
            ros_ns - self._began_ns,
            wall_s,
            wall_s - self._began_s,
            self.is_paused,
            self._pace.step(ros_ns, wall_s, self.is_paused),
            messages is not None,
            self._clock_rate.step(messages or 0, self.core.clock()),
        )
        return {"clock": clock}

    def statuses(self) -> Mapping[str, Status]:
        """What is worth knowing of the time."""
        status = self.ros.status(self.core.offers)
        return {"Time": status} if status else {}

    def _start(self) -> None:
        """Count elapsed time from now on."""
        self._began_ns = 0  # until ROS time is known
        self._began_s = time.time()

    def _reset(self, command: Reset, sender: Sender) -> None:
        self._reset_all()
        self._start()

    def _pause(self, command: Pause, sender: Sender) -> None:
        self._paused_ns = self.core.frames.now_ns if command.paused else None
