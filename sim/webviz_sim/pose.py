"""Poses in the plane."""

import math
from typing import NamedTuple


class Pose(NamedTuple):
    """A frame in the plane, seen from its parent: metres, and radians counter-clockwise."""

    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0

    def __matmul__(self, other: "Pose") -> "Pose":
        """Composition: `a_from_b @ b_from_c` is `a_from_c`."""
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        return Pose(
            self.x + cos * other.x - sin * other.y,
            self.y + sin * other.x + cos * other.y,
            wrap(self.yaw + other.yaw),
        )

    def inverse(self) -> "Pose":
        """The parent, seen from this frame."""
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        return Pose(-cos * self.x - sin * self.y, sin * self.x - cos * self.y, wrap(-self.yaw))

    def towards(self, other: "Pose", fraction: float) -> "Pose":
        """The pose a fraction of the way to another, turning the short way round."""
        return Pose(
            self.x + fraction * (other.x - self.x),
            self.y + fraction * (other.y - self.y),
            wrap(self.yaw + fraction * wrap(other.yaw - self.yaw)),
        )


def wrap(angle: float) -> float:
    """The same angle in [-pi, pi]."""
    return math.remainder(angle, math.tau)
