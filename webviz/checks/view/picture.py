"""Positions of boxes in the picture of a camera."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from webviz.api.bounds import Box
from webviz.api.observation import Observation
from webviz.api.views import FIELD_OF_VIEW, Camera, TopDownOrtho
from webviz.api.views.placement import FLAT_FIELD_OF_VIEW

MAX_DEPTH_M = 100_000.0
"""Farther away nothing is drawn."""


class InPicture(NamedTuple):
    """The position of a box in a picture.

    Args:
        is_inside: whether a part of it may be in the picture, or beyond its depth.
        depth_m: distance along the view of its nearest corner.
        pixels: its diagonal.
    """

    is_inside: bool
    depth_m: float
    pixels: float


def places(observation: Observation, box: Box) -> Iterator[InPicture]:
    """Return the position of a box in the picture of each browser whose camera is known."""
    for browser in observation.browsers:
        camera = observation.cameras.get(browser.id)
        if camera is not None:
            is_flat = isinstance(browser.view, TopDownOrtho)
            view_rad = FLAT_FIELD_OF_VIEW if is_flat else FIELD_OF_VIEW
            yield place(camera, browser.size, view_rad, box)


def place(camera: Camera, size: tuple[float, float], view_rad: float, box: Box) -> InPicture:
    """Return the position of a box in a picture.

    Args:
        camera: in the coordinates of the box, upright.
        size: width and height in pixels.
        view_rad: vertical field of view.
        box: in metres.
    """
    ahead = camera.look_at - camera.position
    ahead = ahead / max(float(np.linalg.norm(ahead)), 1e-12)
    right = np.cross(ahead, (0.0, 0.0, 1.0))
    right = right / max(float(np.linalg.norm(right)), 1e-12)
    corners = np.array(np.meshgrid(*zip(box.low, box.high, strict=True))).reshape(3, 8).T
    axes = np.column_stack((right, np.cross(right, ahead), ahead))
    x, y, z = ((corners - camera.position) @ axes).T
    steep = math.tan(view_rad / 2.0)
    wide = steep * size[0] / max(size[1], 1.0)
    is_outside = any(
        bool(np.all(side))
        for side in (z <= 0.0, x > wide * z, x < -wide * z, y > steep * z, y < -steep * z)
    )
    middle_m = float(((box.low + box.high) / 2.0 - camera.position) @ ahead)
    diagonal_m = float(np.linalg.norm(box.high - box.low))
    pixels = diagonal_m * size[1] / (2.0 * steep * max(middle_m, 1e-9))
    return InPicture(not is_outside, float(z.min()), pixels)
