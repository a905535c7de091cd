"""Points that something nearer hides from the camera: RViz's occlusion compensation."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from webviz import Pose
from webviz.data.images import CameraModel

U8 = NDArray[np.uint8]
F32 = NDArray[np.float32]

NEARER_M = 0.01
"""Distance by which a point must be nearer to hide another, and a camera may move."""
TURNED = math.cos(math.radians(0.5) / 2)
"""Product of two quaternions that are half a degree apart."""


class HiddenPoints(NamedTuple):
    """Points seen earlier behind those of the newest image.

    Args:
        is_hidden: bool (H, W), pixels behind whose point there is another.
        depths: (H, W), of these, in metres.
        colors: (H, W, 3) of these, None without a colour image.
    """

    is_hidden: NDArray[np.bool_]
    depths: F32
    colors: U8 | None


class Hidden:
    """The farthest point of each pixel of a camera that stands still."""

    def __init__(self) -> None:
        self._model: CameraModel | None = None
        self._pose = Pose()
        self._now_ns = 0
        self._depths = np.zeros((0, 0), np.float32)
        self._seen_ns = np.zeros((0, 0), np.int64)
        self._colors: U8 | None = None

    def behind(
        self,
        depths: F32,
        is_valid: NDArray[np.bool_],
        colors: U8 | None,
        *,
        model: CameraModel,
        pose: Pose,
        now_ns: int,
        time_out: float,
    ) -> HiddenPoints:
        """Take an image in, and say what it hides.

        Args:
            depths: (H, W), metres.
            is_valid: (H, W), pixels with a depth.
            colors: (H, W, 3), if there are any.
            model: of the camera.
            pose: of the camera in the fixed frame; what was seen from another is dropped.
            now_ns: ROS time.
            time_out: seconds for which a point that is hidden is kept.
        """
        if not self._continues(depths, colors, model, pose, now_ns):
            self._model, self._pose = model, pose
            self._depths = np.zeros_like(depths)
            self._seen_ns = np.zeros(depths.shape, np.int64)
            self._colors = None if colors is None else np.zeros_like(colors)
        self._now_ns = now_ns
        # In float, as a time-out may be longer than an integer can count.
        self._depths[(now_ns - self._seen_ns) * 1e-9 > time_out] = 0.0
        nearer = np.where(is_valid, depths, -np.inf) < self._depths - np.float32(NEARER_M)
        is_hidden = nearer & (self._depths > 0)
        is_farthest = is_valid & ~is_hidden
        self._depths = np.where(is_farthest, depths, self._depths)
        self._seen_ns = np.where(is_farthest, now_ns, self._seen_ns)
        if colors is not None and self._colors is not None:
            self._colors = np.where(is_farthest[..., None], colors, self._colors)
        return HiddenPoints(is_hidden, self._depths, self._colors)

    def _continues(
        self, depths: F32, colors: U8 | None, model: CameraModel, pose: Pose, now_ns: int
    ) -> bool:
        """Return whether an image shows what the former ones did, as far as can be known."""
        # From where the background was begun, so that a slow drift counts too.
        far = math.dist(pose.position, self._pose.position)
        aligned = abs(float(np.dot(pose.wxyz, self._pose.wxyz)))
        return (
            self._model == model
            and self._depths.shape == depths.shape
            and (self._colors is None) == (colors is None)
            and self._now_ns <= now_ns
            and far <= NEARER_M
            and aligned >= TURNED
        )
