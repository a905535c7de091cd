"""Camera model: sensor_msgs/CameraInfo for rectified images (REP 104)."""

from __future__ import annotations

import math
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz.data.images.errors import ImageError

F32 = NDArray[np.float32]
F64 = NDArray[np.float64]

NARROWEST, WIDEST = 1e-6, 1e4
"""Metres that an image may span 1 m ahead of its camera, and be beside its axis."""


class CameraModel(msgspec.Struct, frozen=True):
    """A camera without distortion, in its optical frame: x to the right, y down, z ahead.

    Args:
        width, height: of its images in pixels, with the region of interest and binning applied.
        fx, fy, cx, cy: focal lengths and principal point of these images, in pixels.
        center: of projection in metres; the right camera of a stereo pair is beside its frame.
    """

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    center: tuple[float, float] = (0.0, 0.0)

    @staticmethod
    def of(info: Any, otherwise: tuple[int, int] = (0, 0)) -> CameraModel:
        """Return the camera of a sensor_msgs/CameraInfo: P, or K if P is empty.

        Args:
            info: a sensor_msgs/CameraInfo.
            otherwise: width and height in pixels for a camera info without a size.

        Raises:
            ImageError: it is not calibrated, or its numbers are invalid.
        """
        roi = info.roi
        least = int(roi.width) or otherwise[0], int(roi.height) or otherwise[1]
        whole = CameraModel.whole(info, least)
        width, height = int(roi.width) or whole.width, int(roi.height) or whole.height
        bx, by = binning(info)
        left, top = int(roi.x_offset), int(roi.y_offset)
        return _checked(
            CameraModel(
                max(width // bx, 1),
                max(height // by, 1),
                whole.fx / bx,
                whole.fy / by,
                (whole.cx - left) / bx,
                (whole.cy - top) / by,
                whole.center,
            )
        )

    @staticmethod
    def whole(info: Any, otherwise: tuple[int, int] = (0, 0)) -> CameraModel:
        """Return the camera of the whole sensor, without region of interest and binning.

        Raises:
            ImageError: it is not calibrated, or its numbers are invalid.
        """
        p, k = [float(each) for each in info.p], [float(each) for each in info.k]
        fx, fy, cx, cy, tx, ty = p[0], p[5], p[2], p[6], p[3], p[7]
        if not any(p):
            fx, fy, cx, cy, tx, ty = k[0], k[4], k[2], k[5], 0.0, 0.0
        if not any(p) and not any(k):
            raise ImageError(
                "The camera is not calibrated: K and P are all zero. Calibrate it, or load its "
                "calibration file in the driver."
            )
        if not all(map(math.isfinite, (fx, fy, cx, cy, tx, ty))) or not (fx > 0 and fy > 0):
            raise ImageError(
                f"The focal lengths {fx:g} and {fy:g} px or the principal point {cx:g}, {cy:g} of "
                f"{'P' if any(p) else 'K'} are invalid. Calibrate the camera."
            )
        width, height = int(info.width) or otherwise[0], int(info.height) or otherwise[1]
        if not width or not height:
            raise ImageError(
                f"The camera info has a size of {info.width} x {info.height} pixels. Set width and "
                "height in the driver."
            )
        center = -tx / fx, -ty / fy
        if not max(map(abs, center)) < 1e6:
            raise ImageError("The last column of P puts the camera farther away than 1000 km.")
        return _checked(CameraModel(width, height, fx, fy, cx, cy, center))

    def rays(self, columns: F64, rows: F64) -> F64:
        """Directions (..., 3) of places in the image, 1 m ahead; (0, 0) is the corner of a pixel.

        The centre of the first pixel is at 0, 0 of P, hence its corner at -0.5, -0.5.
        """
        x = (columns - 0.5 - self.cx) / self.fx
        y = (rows - 0.5 - self.cy) / self.fy
        return np.stack(np.broadcast_arrays(x, y, np.ones_like(x)), axis=-1)

    def corners(self, distance: float) -> F64:
        """Return the corners of the image (4, 3) at a distance, around from the upper left one."""
        columns = np.array([0.0, self.width, self.width, 0.0])
        rows = np.array([0.0, 0.0, self.height, self.height])
        return self.rays(columns, rows) * distance + (*self.center, 0.0)

    def points(self, depths: NDArray[np.floating[Any]], step: int) -> F32:
        """Points (H, W, 3) of every `step`-th pixel, seen from the origin of the frame.

        `center` is not used, as in RViz and depth_image_proc: depths of the right camera of a
        stereo pair come in a frame of its own.

        Args:
            depths: (H, W) of these pixels, in metres along z.
            step: of rows and columns.
        """
        rows, columns = depths.shape
        rays = self._rays(rows, columns, step)
        z = depths.astype(np.float32, copy=False).reshape(-1)
        points = np.empty((z.size, 3), np.float32)
        for axis, ray in enumerate(rays):
            np.multiply(ray, z, out=points[:, axis])
        points[:, 2] = z
        return points.reshape(rows, columns, 3)

    def _rays(self, rows: int, columns: int, step: int) -> tuple[F32, F32]:
        """Return x and y of every `step`-th pixel 1 m ahead: (N,), as rows take 10 times as
        long."""
        x = ((np.arange(columns) * step - self.cx) / self.fx).astype(np.float32)
        y = ((np.arange(rows) * step - self.cy) / self.fy).astype(np.float32)
        return np.tile(x, rows), np.repeat(y, columns)


def _checked(model: CameraModel) -> CameraModel:
    """Return a model whose image is somewhere in front of the camera, and not a point."""
    with np.errstate(over="ignore"):  # refused below
        corners = np.abs(model.corners(1.0) - (*model.center, 0.0))[:, :2]
    spans = model.width / model.fx, model.height / model.fy
    if not (corners.max() < WIDEST and min(spans) > NARROWEST):
        raise ImageError(
            f"Focal lengths of {model.fx:.4g} and {model.fy:.4g} px and a principal point at "
            f"{model.cx:.4g}, {model.cy:.4g} do not fit an image of {model.width} x {model.height} "
            "pixels. Calibrate the camera."
        )
    return model


def calibration_problem(info: Any) -> str:
    """Return why the numbers of a camera info other than P are invalid, "" if they are valid.

    Args:
        info: a sensor_msgs/CameraInfo.
    """
    invalid = [
        name
        for name, values in (("K", info.k), ("D", info.d), ("R", info.r))
        if not np.isfinite(np.asarray(values, np.float64)).all()
    ]
    if not invalid and not (info.k[0] > 0 and info.k[4] > 0):
        invalid = ["K"]
    if not invalid:
        return ""
    return (
        f"{' and '.join(invalid)} of the camera info {'are' if invalid[1:] else 'is'} invalid "
        "and ignored. Calibrate the camera."
    )


def binning(info: Any) -> tuple[int, int]:
    """Columns and rows of the sensor for each pixel of an image; 0 means 1."""
    return max(int(info.binning_x), 1), max(int(info.binning_y), 1)


def optical_problem(frame: str) -> str:
    """Return why a camera's frame is hardly its optical one, "" if it may be."""
    name = frame.rpartition("/")[2].lower()
    if "optical" in name or not name.endswith(("link", "frame", "base")):
        return ""
    return (
        f"'{frame}' looks like the frame of a camera's body, whose x points ahead; images need its "
        "optical frame, whose z does. Set frame_id in the driver, such as "
        f"'{frame.removesuffix('_link').removesuffix('_frame')}_optical_frame'."
    )
