"""Following a path: pure pursuit."""

import math

import numpy as np
from numpy.typing import NDArray

from webviz_sim.pose import Pose2D, wrap

LOOKAHEAD = 0.35  # m
TOLERANCE = 0.12  # m from the end of the path at which it counts as reached
ACCELERATION = 0.6  # m/s^2
ANGULAR_ACCELERATION = 4.0  # rad/s^2
TURN_RATE = 1.2  # rad/s, at most
TURN_FIRST = 1.0  # rad of heading error from which the robot turns on the spot


class Follower:
    """Drives along one path.

    Pure pursuit (Coulter, "Implementation of the Pure Pursuit Path Tracking Algorithm", 1992):
    steer along the arc that meets the path at a fixed distance ahead, whose curvature is
    2 sin(heading error) / distance. Velocities change no faster than a small robot's do.
    """

    def __init__(self, path: NDArray[np.float64], yaw: float | None = None):
        """Start at the beginning of the path.

        Args:
            path: Points in the map frame, shape (n, 2), n at least 2.
            yaw: Heading at the end in rad; None for any.
        """
        self._path = path
        self._yaw = yaw
        self._passed = 0
        self.done = False

    def remaining(self) -> NDArray[np.float64]:
        """Return the points still ahead, shape (n, 2); none when the robot has arrived."""
        return self._path[self._passed :] if not self.done else self._path[:0]

    def step(
        self, pose: Pose2D, velocity: tuple[float, float], speed: float, seconds: float
    ) -> tuple[float, float]:
        """Return the linear and angular velocity for the next step, in m/s and rad/s.

        Args:
            pose: The robot in the map frame.
            velocity: Its current linear and angular velocity.
            speed: Maximum linear velocity in m/s.
            seconds: Length of the step.
        """
        linear, angular = self._wanted(pose, speed)
        return (
            _approach(velocity[0], linear, ACCELERATION * seconds),
            _approach(velocity[1], angular, ANGULAR_ACCELERATION * seconds),
        )

    def _wanted(self, pose: Pose2D, speed: float) -> tuple[float, float]:
        here = pose.x, pose.y
        # Look ahead a little only, so that a path that crosses itself is not cut short.
        window = self._path[self._passed : self._passed + 30]
        distances = np.hypot(*(window - here).T)
        nearest = int(distances.argmin())
        self._passed += nearest
        ahead = window[nearest:][distances[nearest:] >= LOOKAHEAD]
        target = ahead[0] if len(ahead) else window[-1]
        to_end = math.dist(here, self._path[-1])
        at_end = self._passed + len(window) - nearest >= len(self._path)
        if at_end and to_end < TOLERANCE:
            return 0.0, self._final_turn(pose)
        error = wrap(math.atan2(target[1] - pose.y, target[0] - pose.x) - pose.yaw)
        turn = min(max(2.5 * error, -TURN_RATE), TURN_RATE)
        if abs(error) > TURN_FIRST:
            return 0.0, turn
        distance = max(math.dist(here, target), TOLERANCE)
        curvature = 2.0 * math.sin(error) / distance
        # Slow enough to take the curve, and to stop at the end.
        linear = min(speed, TURN_RATE / max(abs(curvature), 1e-6))
        if at_end:
            linear = min(linear, math.sqrt(2.0 * 0.5 * ACCELERATION * to_end))
        return linear, curvature * linear

    def _final_turn(self, pose: Pose2D) -> float:
        error = 0.0 if self._yaw is None else wrap(self._yaw - pose.yaw)
        self.done = abs(error) < 0.05
        return 0.0 if self.done else min(max(2.5 * error, -TURN_RATE), TURN_RATE)


def _approach(value: float, target: float, step: float) -> float:
    return min(max(target, value - step), value + step)
