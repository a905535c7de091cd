"""Poses in the plane."""

import math
from typing import NamedTuple


class Pose2D(NamedTuple):
    """A frame in the plane, seen from its parent: metres, and radians counter-clockwise."""

    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0

    def __matmul__(self, other: "Pose2D") -> "Pose2D":
        """Composition: `a_from_b @ b_from_c` is `a_from_c`."""
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        return Pose2D(
            self.x + cos * other.x - sin * other.y,
            self.y + sin * other.x + cos * other.y,
            wrap(self.yaw + other.yaw),
        )

    def inverse(self) -> "Pose2D":
        """Return the parent, seen from this frame."""
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        return Pose2D(-cos * self.x - sin * self.y, sin * self.x - cos * self.y, wrap(-self.yaw))


def wrap(angle: float) -> float:
    """Return the same angle in [-pi, pi]."""
    return math.remainder(angle, math.tau)
