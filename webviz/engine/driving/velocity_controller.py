"""The controller of one vehicle: who drives it, and how fast it should move now."""

from __future__ import annotations

import math

import msgspec

from webviz.api.vehicle import STILL, Vehicle, Velocity
from webviz.sources.graph import Advertisement

BEAT_S = 0.2
"""A driver who acknowledges nothing new for so long has lost control."""
RELEASE_S = 1.0
"""Time in seconds from letting go until another browser may drive."""
PERIOD_S = 0.05
"""Period in seconds between two commands."""
TAIL = 5
"""Zeros that end a drive, in case that one of them is lost."""


class DrivingAnswer(msgspec.Struct, frozen=True):
    """Answer to a browser about its velocity controller.

    Args:
        driver: id of the browser that drives, None if it is free.
        problem: why commands do not reach the robot, with a remedy; "" if they do.
    """

    driver: int | None = None
    problem: str = ""


class VelocityController:
    """Turns the set-points of one browser at a time into velocities. Times are monotonic, in s.

    Args:
        vehicle: what is driven; may be replaced by one with other limits.
        advertisement: where its commands go.
        holding: id of a browser that has to let go first: what it holds was meant for another one.
    """

    def __init__(
        self, vehicle: Vehicle, advertisement: Advertisement, holding: int | None = None
    ) -> None:
        self.vehicle = vehicle
        self.advertisement = advertisement
        self._holding = holding
        self._driver: int | None = None
        self._target = STILL
        self._velocity = STILL
        self._heartbeat = self._heard = self._last_set_point = self._stepped = -math.inf
        self._tail = 0

    @property
    def is_at_rest(self) -> bool:
        """Return whether there is nothing to publish."""
        return self._target == self._velocity == STILL and self._tail == 0

    @property
    def deadline(self) -> float:
        """Return when it stops unless its driver is heard again."""
        return math.inf if self._target == STILL else self._heard + BEAT_S

    def driver(self, now: float) -> int | None:
        """Return the browser in control."""
        is_held = self._velocity != STILL or now - self._last_set_point < RELEASE_S
        return self._driver if is_held else None

    def steer(self, browser: int, share: Velocity, heartbeat: float, now: float) -> bool:
        """Take a set-point, unless another browser is in control.

        Set-points with the same `heartbeat` count once: people whose page still sends, but receives
        nothing, do not see the robot.

        Args:
            browser: its id.
            share: of the limits, from -1 to 1; what is not finite counts as 0.
            heartbeat: when the newest of what the browser has received was sent.
            now: the time.

        Returns:
            Whether something else is wanted now.
        """
        if self.driver(now) not in (None, browser):
            return False
        velocity = Velocity(*map(_part, share, self.vehicle.limits))
        if browser == self._holding:
            self._holding = None if velocity == STILL else browser
            return False
        if velocity == STILL and self._driver != browser:
            return False  # only looks at the controller
        if self._driver != browser or heartbeat > self._heartbeat:
            self._heartbeat, self._heard = heartbeat, now
        elif now >= self._heard + BEAT_S:
            return False
        if velocity != STILL:
            self._driver, self._last_set_point = browser, now
        before, self._target = self._target, velocity
        return velocity != before

    def halt(self) -> None:
        """Stop at once."""
        if not self._target == self._velocity == STILL:
            self._target = self._velocity = STILL
            self._tail = TAIL

    def begin_again(self) -> None:
        """Speed up from standstill, as a command has not reached the robot."""
        self._velocity = STILL

    def step(self, now: float) -> Velocity | None:
        """Return the velocity to publish now; None at rest."""
        if now >= self.deadline:
            self.halt()
        if self.is_at_rest:
            return None
        seconds = min(now - self._stepped, PERIOD_S)
        self._stepped = now
        vehicle = self.vehicle
        self._velocity = Velocity(
            *(
                _approach(value, target, up * seconds, down * seconds)
                for value, target, up, down in zip(
                    self._velocity,
                    self._target,
                    vehicle.acceleration,
                    vehicle.deceleration,
                    strict=True,
                )
            )
        )
        if self._target == self._velocity == STILL:
            self._tail -= 1
        else:
            self._tail = TAIL
        return self._velocity


def _part(share: float, limit: float) -> float:
    """Return a share of a limit."""
    # Adding 0 makes -0.0 a 0.0.
    return min(max(share, -1.0), 1.0) * limit + 0.0 if math.isfinite(share) else 0.0


def _approach(value: float, target: float, up: float, down: float) -> float:
    """Return a step towards another speed: by `down` to zero first, by `up` from there."""
    if value == 0.0 or (value * target > 0.0 and abs(target) > abs(value)):
        return min(max(target, value - up), value + up)
    nearest = target if value * target > 0.0 else 0.0
    return min(max(nearest, value - down), value + down)
