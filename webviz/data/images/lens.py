"""Lenses: where the image of a camera has what its rectified image shows (REP 104).

The models are those of OpenCV's calib3d module: plumb_bob and rational_polynomial are in the
description of `projectPoints`, equidistant is `fisheye::projectPoints`.
"""

from __future__ import annotations

from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz.data.images.camera_model import F64, CameraModel, calibration_problem
from webviz.data.images.errors import ImageError

MODELS = ("plumb_bob", "rational_polynomial", "equidistant")
CELLS = (48, 36)
"""Cells of a grid, along columns and rows: straight lines in them are off by 0.1 px."""
NEGLIGIBLE_PX = 0.25
_SAMPLES = 1024
_MAX_COEFFICIENTS = {"plumb_bob": 5, "rational_polynomial": 12, "equidistant": 4}
"""Coefficients; those behind, which tilt the sensor, have to be zero."""
_LENGTHS = (4, 5, 8, 12, 14)
"""Lengths of D, as OpenCV takes it."""
_LEAST_SHARE = 0.01
"""Share of the rectified image that a lens sees at least."""
_TURNED = 0.01
"""Largest difference of the columns of a rotation from perpendicular unit vectors."""


class Lens(msgspec.Struct, frozen=True):
    """Lens of a camera before its image is rectified.

    Args:
        model: one of `MODELS`.
        coefficients: D of the camera info, completed with zeros.
        focal: fx and fy of K, in pixels of the whole sensor.
        principal: cx and cy of K.
        rotation: R by rows, which turns the rays of the camera into those of the rectified image.
        part: left, top, width and height of its images on the sensor in pixels.
    """

    model: str
    coefficients: tuple[float, ...]
    focal: tuple[float, float]
    principal: tuple[float, float]
    rotation: tuple[float, ...]
    part: tuple[int, int, int, int]

    @staticmethod
    def of(info: Any, otherwise: tuple[int, int] = (0, 0)) -> Lens:
        """Return the lens of a sensor_msgs/CameraInfo.

        Args:
            info: with a valid P, see `CameraModel.whole`.
            otherwise: width and height in pixels for a camera info without a size.

        Raises:
            ImageError: its model is unsupported, or its numbers are invalid.
        """
        if problem := calibration_problem(info):
            raise ImageError(problem)
        few = info.d[: _LENGTHS[-1] + 1]
        d, k, r = (tuple(float(each) for each in values) for values in (few, info.k, info.r))
        model = str(info.distortion_model) if any(d) else "plumb_bob"
        is_known = model in MODELS and not any(d[_MAX_COEFFICIENTS[model] :])
        if not is_known or (any(d) and len(d) not in _LENGTHS):
            more = f" with {len(info.d)} coefficients" if model in MODELS else ""
            raise ImageError(
                f"Unsupported distortion model {model[:40]!a}{more}; expected one of "
                f"{', '.join(MODELS)}. The scene fits rectified images only."
            )
        turn = np.reshape(r, (3, 3)) if any(r) else np.eye(3)
        with np.errstate(all="ignore"):
            if not np.abs(turn @ turn.T - np.eye(3)).max() < _TURNED:
                raise ImageError("R of the camera info is not a rotation. Calibrate the camera.")
        roi = info.roi
        width, height = int(info.width) or otherwise[0], int(info.height) or otherwise[1]
        size = int(roi.width) or width, int(roi.height) or height
        return Lens(
            model,
            (*d, *[0.0] * 12)[:12],
            (k[0], k[4]),
            (k[2], k[5]),
            tuple(turn.ravel().tolist()),
            (int(roi.x_offset), int(roi.y_offset), *size),
        )

    def project(self, rays: F64) -> F64:
        """Return where rays of the rectified camera meet the sensor: pixels (..., 2).

        The centre of the first pixel is at 0, 0. Rays that the lens does not see are NaN: beyond
        the angle at which its polynomial turns back.

        Args:
            rays: (..., 3), of any length; z points ahead.
        """
        with np.errstate(all="ignore"):
            bent = self._bent(rays @ np.reshape(self.rotation, (3, 3)))
            return bent * self.focal + self.principal

    def grid(self, model: CameraModel) -> NDArray[np.float32] | None:
        """Return the place in the image for each place of the rectified image.

        Args:
            model: of the rectified image, see `CameraModel.whole`.

        Returns:
            float32 (R, C, 2), of evenly spaced places from corner to corner: column and row as
            shares of the image's width and height; NaN outside of what the lens sees. None if the
            image is rectified as it is.

        Raises:
            ImageError: the lens sees nothing of it.
        """
        columns = np.linspace(0.0, model.width, CELLS[0] + 1)
        rows = np.linspace(0.0, model.height, CELLS[1] + 1)
        places = np.stack(np.meshgrid(columns, rows), axis=-1)
        left, top, width, height = self.part
        pixels = self.project(model.rays(places[..., 0], places[..., 1])) + 0.5
        with np.errstate(all="ignore"):
            if (np.abs(pixels - places) < NEGLIGIBLE_PX).all():
                return None
            shares = ((pixels - (left, top)) / (width, height)).astype(np.float32)
            if (np.abs(shares - 0.5) < 1.0).all(axis=-1).mean() < _LEAST_SHARE:
                raise ImageError(
                    "According to K, D and R, the camera sees nothing of what P shows. "
                    "Calibrate the camera."
                )
            return shares

    def _bent(self, rays: F64) -> F64:
        """Return where rays meet a plane 1 m ahead of the camera, behind the lens."""
        x, y, z = np.moveaxis(rays, -1, 0)
        if self.model == "equidistant":
            across = np.hypot(x, y)
            angle = np.arctan2(across, z)
            scale = _forward(self._equidistant, angle) / np.maximum(across, 1e-12)
            return np.stack((x * scale, y * scale), axis=-1)
        x, y = (np.where(z > 1e-9, each / z, np.nan) for each in (x, y))
        _, _, p1, p2 = self.coefficients[:4]
        s1, s2, s3, s4 = self.coefficients[8:12]
        r = np.hypot(x, y)
        r2, xy = r * r, 2 * x * y
        scale = _forward(self._radial, r) / np.maximum(r, 1e-12)
        return np.stack(
            (
                x * scale + p1 * xy + p2 * (r2 + 2 * x * x) + s1 * r2 + s2 * r2 * r2,
                y * scale + p1 * (r2 + 2 * y * y) + p2 * xy + s3 * r2 + s4 * r2 * r2,
            ),
            axis=-1,
        )

    def _radial(self, r: F64) -> F64:
        k1, k2, _, _, k3, k4, k5, k6 = self.coefficients[:8]
        r2 = r * r
        below = 1 + r2 * (k4 + r2 * (k5 + r2 * k6))
        return np.where(below > 0, r * (1 + r2 * (k1 + r2 * (k2 + r2 * k3))) / below, np.nan)

    def _equidistant(self, angle: F64) -> F64:
        k1, k2, k3, k4 = self.coefficients[:4]
        a2 = angle * angle
        return angle * (1 + a2 * (k1 + a2 * (k2 + a2 * (k3 + a2 * k4))))


def _forward(bend: Any, values: F64) -> F64:
    """`bend(values)` up to where it stops growing, NaN beyond."""
    most = float(np.nanmax(values, initial=0.0))
    samples = np.linspace(0.0, most, _SAMPLES)
    is_back = ~(np.diff(bend(samples)) > 0)
    end = samples[np.argmax(is_back)] if is_back.any() and most > 0 else most
    return np.where(values <= end, bend(values), np.nan)
