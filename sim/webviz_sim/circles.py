"""Round obstacles: how near they are, and where rays meet them."""

import math

import numpy as np
from numpy.typing import NDArray

Circles = NDArray[np.float64]
"""Shape (n, 3): x, y and radius of round obstacles in the map, in metres."""

NONE: Circles = np.empty((0, 3))


def nearest(circles: Circles, x: float, y: float) -> float:
    """Distance in metres from a point to the nearest circle, infinite without one."""
    if not len(circles):
        return math.inf
    return float((np.hypot(circles[:, 0] - x, circles[:, 1] - y) - circles[:, 2]).min())


def cast(
    circles: Circles, x: NDArray[np.float64], y: NDArray[np.float64], angles: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the distance rays travel until they meet a circle, in the units of the circles.

    Args:
        circles: of the world.
        x: Shape (n,), start of each ray.
        y: Shape (n,), start of each ray.
        angles: Shape (n,), its direction in radians.

    Returns:
        Shape (n,), infinite for rays that meet none; circles around their start are ignored.
    """
    ahead_x, ahead_y = np.cos(angles), np.sin(angles)
    to_x, to_y = circles[:, :1] - x, circles[:, 1:2] - y
    along = to_x * ahead_x + to_y * ahead_y
    half_chord = circles[:, 2:] ** 2 - (to_x * ahead_y - to_y * ahead_x) ** 2
    near = along - np.sqrt(np.maximum(half_chord, 0.0))
    return np.where((half_chord > 0.0) & (near > 0.0), near, np.inf).min(axis=0, initial=np.inf)
