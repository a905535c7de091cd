"""The state of a path that is shown: an animation, or a point that somebody chose."""

from __future__ import annotations

import math
from typing import NamedTuple

import msgspec
import numpy as np

from webviz_displays.moveit.paths import JointPath

DEFAULT_SPEED = "3x"


class Speed(NamedTuple):
    """Speed of the animation of a path.

    Attributes:
        factor: of its own time, or 0.
        state_s: seconds for each of its points, or 0.
    """

    factor: float = 3.0
    state_s: float = 0.0

    def ahead(self, path: JointPath, place: float, seconds: float) -> float:
        """Return the place after some time.

        A place is the number of a point, and parts to the next.
        """
        if self.state_s:
            return place + seconds / self.state_s
        numbers = np.arange(len(path))
        time_s = float(np.interp(place, numbers, path.times)) + seconds * self.factor
        if time_s > path.times[-1]:
            return float(len(path))
        return float(np.interp(time_s, path.times, numbers))


def speed_of(text: str) -> Speed | None:
    """Return a speed as MoveIt writes it: "3x", "0.05 s" or "REALTIME"; None if it is invalid."""
    words = text.strip()
    if words.upper() == "REALTIME":
        return Speed(1.0, 0.0)
    try:
        value = float(words[:-1])
    except ValueError:
        return None
    if not 0.0 < value < math.inf or words[-1] not in "xs":
        return None
    return Speed(value, 0.0) if words[-1] == "x" else Speed(0.0, value)


class PathPlayer(msgspec.Struct):
    """Plays the newest path.

    Args:
        path: that is played, None before the first.
        place: in it; see `Speed.ahead`.
        is_moving: whether the animation goes on.
    """

    path: JointPath | None = None
    place: float = 0.0
    is_moving: bool = False
    _newest: JointPath | None = None
    _clock_s: float = 0.0

    @property
    def index(self) -> int:
        """The number of the point that is shown."""
        return min(int(self.place), len(self.path) - 1) if self.path else 0

    def take(self, path: JointPath | None, interrupts: bool) -> None:
        """Take the newest path, to be played now or after the current one."""
        if path is None:
            self.path, self._newest, self.is_moving = None, None, False
        elif path is not self._newest:
            self._newest = path
            if interrupts or not self.is_moving:
                self._start(path)

    def step(self, clock_s: float, speed: Speed, loops: bool) -> None:
        """Go on to a time, in seconds."""
        passed, self._clock_s = max(clock_s - self._clock_s, 0.0), clock_s
        if self.path is None or not (self.is_moving or loops):
            return
        if not self.is_moving:
            self._start(self.path)
        elif passed:
            self.place = speed.ahead(self.path, self.place, passed)
        if self.place < len(self.path):
            return
        if self._newest is not None and self._newest is not self.path:
            self._start(self._newest)
        elif loops:
            self._start(self.path)
        else:
            self.place, self.is_moving = float(len(self.path) - 1), False

    def hold(self, share: float) -> None:
        """Show the point at a share of the newest path, 0 to 1."""
        if self._newest is not None:
            self.path, self.is_moving = self._newest, False
            self.place = float(round(share * (len(self._newest) - 1)))

    def _start(self, path: JointPath) -> None:
        self.path, self.place, self.is_moving = path, 0.0, len(path) > 0
