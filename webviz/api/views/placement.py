"""Conversion of views to cameras and back."""

from __future__ import annotations

import math
from dataclasses import dataclass

import msgspec
import numpy as np
from numpy.typing import ArrayLike, NDArray

from webviz.api.views.types import FPS, FrameAligned, Orbit, TopDownOrtho, V, View, like

FIELD_OF_VIEW = math.pi / 4
"""Vertical, as in RViz (Ogre's default)."""
FLAT_FIELD_OF_VIEW = math.radians(1.0)
"""Flat field of view of a distant camera that stands in for an orthographic one with the ground at
the same scale. Code that uses field of view and distance of the camera then sizes and moves things
correctly."""
RAISED = 0.2
"""Offset of XYOrbit along the camera's up vector, as a share of the distance; RViz's."""
STEEPEST = 1.5698
"""Maximum pitch at which the yaw is still defined."""
EYE = 1e-3
"""Distance from the camera of an FPS view to its centre of rotation, in metres."""
TILT = 1e-5
"""Tilt of a TopDownOrtho camera in radians, so that its angle is defined."""
DIGITS = 6
ASSUMED_PX = 800.0
"""Height of a picture before the page reports it; the page corrects the distance."""

FLIPPED = np.array((1.0, -1.0, -1.0))
"""Signs of coordinates that are rotated by 180 degrees about x, as RViz inverts the z axis."""
AXIS_M = 5.0
"""Distance of a FrameAligned camera behind the origin of its frame at first; RViz's."""

Vector = NDArray[np.float64]
"""float64 (3,), metres."""


@dataclass(frozen=True)
class Camera:
    """An upright camera in the coordinates of a view, see `Rig`."""

    position: Vector
    look_at: Vector

    @property
    def distance(self) -> float:
        """Distance from the camera to its focal point, in metres."""
        return float(np.linalg.norm(self.position - self.look_at))


def camera_of(view: View, height_px: float) -> Camera:
    """Return the camera of a view, for a picture of that height."""
    if isinstance(view, FPS):
        position = np.array(view.position)
        return Camera(position, position - EYE * _direction(view.yaw + math.pi, view.pitch))
    if isinstance(view, TopDownOrtho):
        at = np.array((view.x, view.y, 0.0))
        distance = height_px / view.scale / 2.0 / math.tan(FLAT_FIELD_OF_VIEW / 2.0)
        return Camera(at + distance * _direction(view.angle - math.pi / 2, math.pi / 2 - TILT), at)
    at = np.array(view.focal_point)
    if view.invert_z_axis:
        at *= FLIPPED
    if not isinstance(view, Orbit):
        at += RAISED * view.distance * _up(view.yaw, view.pitch)
    return Camera(at + view.distance * _direction(view.yaw, view.pitch), at)


def view_of(view: V, camera: Camera, height_px: float) -> V:
    """Return a view as a camera shows it now.

    The inverse of `camera_of`, rounded to six decimals and clamped to the bounds of the type.

    Args:
        view: has the type, and the options that no camera shows.
        camera: placed by `camera_of` for such a view, and possibly moved since.
        height_px: of the picture.
    """
    offset = camera.position - camera.look_at
    distance = max(float(np.linalg.norm(offset)), 1e-9)
    yaw = math.atan2(offset[1], offset[0])
    pitch = math.asin(min(max(offset[2] / distance, -1.0), 1.0))
    if isinstance(view, FPS):
        return msgspec.structs.replace(
            view,
            yaw=_rounded(_wrapped(yaw + math.pi)),
            pitch=_pitch(pitch),
            position=_point(camera.position),
        )
    if isinstance(view, TopDownOrtho):
        scale = height_px / 2.0 / math.tan(FLAT_FIELD_OF_VIEW / 2.0) / distance
        return msgspec.structs.replace(
            view,
            scale=min(max(_rounded(scale), 1e-5), 1e6),
            angle=_rounded(_wrapped(yaw + math.pi / 2)),
            x=_rounded(camera.look_at[0]),
            y=_rounded(camera.look_at[1]),
        )
    raised = 0.0 if isinstance(view, Orbit) else RAISED * distance
    pitch = _pitch(pitch)
    at = camera.look_at - raised * _up(yaw, pitch)
    return msgspec.structs.replace(
        view,
        distance=min(max(_rounded(distance), 10.0**-DIGITS), 1e6),
        yaw=_rounded(yaw),
        pitch=pitch,
        focal_point=_point(at * FLIPPED if view.invert_z_axis else at),
    )


def zero(view: View) -> View:
    """Return the initial view of the type of a view, with its options."""
    blank = like(type(view), view)
    if not isinstance(blank, FrameAligned) or blank.point_towards == "arbitrary":
        return blank
    sign, name = blank.point_towards[:2]
    axis = np.where(np.array(list("xyz")) == name, -1.0 if sign == "-" else 1.0, 0.0)
    if blank.invert_z_axis:
        axis *= FLIPPED
    return view_of(blank, Camera(-AXIS_M * axis, -(AXIS_M - EYE) * axis), ASSUMED_PX)


def _direction(yaw: float, pitch: float) -> Vector:
    """Return the unit vector from the focal point to the camera."""
    return np.array(
        (math.cos(yaw) * math.cos(pitch), math.sin(yaw) * math.cos(pitch), math.sin(pitch))
    )


def _up(yaw: float, pitch: float) -> Vector:
    """Return the unit vector to the top of the picture of a camera in that direction."""
    return _direction(yaw, pitch + math.pi / 2)


def _wrapped(angle: float) -> float:
    return math.remainder(angle, 2.0 * math.pi)


def _rounded(value: float) -> float:
    return round(float(value), DIGITS) + 0.0  # no minus zero


def _pitch(pitch: float) -> float:
    return min(max(_rounded(pitch), -STEEPEST), STEEPEST)


def _point(xyz: ArrayLike) -> tuple[float, float, float]:
    x, y, z = (np.round(np.asarray(xyz, dtype=np.float64), DIGITS) + 0.0).tolist()
    return x, y, z
