"""Changing a view while keeping what it shows: type, target frame, focus."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from webviz.api.nodes import Pose
from webviz.api.views.placement import (
    FIELD_OF_VIEW,
    FLAT_FIELD_OF_VIEW,
    RAISED,
    STEEPEST,
    Camera,
    Vector,
    camera_of,
    view_of,
)
from webviz.api.views.types import (
    FPS,
    FrameAligned,
    Orbit,
    ThirdPersonFollower,
    TopDownOrtho,
    View,
)
from webviz.data.rotations import Quaternion, from_rpy, matrices, multiply, to_rpy

NEAREST = 1e-3
"""Minimum of the new distance relative to the former; below, the direction is lost."""
REACH = 10.0
"""Metres to the focal point of an FPS view that does not look at the ground."""
FARTHEST = 1000.0
MARGIN = 1.15
SMALLEST = 0.05
"""Minimum radius to focus on, in metres."""
UPSIDE_DOWN = (0.0, 1.0, 0.0, 0.0)
"""Rotation by 180 degrees about x."""
FLATTER = math.tan(FLAT_FIELD_OF_VIEW / 2.0) / math.tan(FIELD_OF_VIEW / 2.0)


@dataclass(frozen=True)
class Rig:
    """The coordinates of a view in the fixed frame: at `origin`, rotated by `wxyz`."""

    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    wxyz: Quaternion = (1.0, 0.0, 0.0, 0.0)

    def outward(self, camera: Camera) -> Camera:
        """Return a camera of these coordinates in the fixed frame."""
        turn, origin = matrices(self.wxyz), np.array(self.origin)
        return Camera(*(turn @ p + origin for p in (camera.position, camera.look_at)))

    def inward(self, camera: Camera) -> Camera:
        """Return a camera of the fixed frame in these coordinates."""
        turn, origin = matrices(self.wxyz), np.array(self.origin)
        return Camera(*(turn.T @ (p - origin) for p in (camera.position, camera.look_at)))


def rig_of(view: View, pose: Pose | None) -> Rig:
    """Return the coordinates of a view that follows its target frame.

    Args:
        view: a ThirdPersonFollower rotates with the yaw of the frame, a FrameAligned one with all
            of its rotation, and an inverted one is upside down.
        pose: of the frame in the fixed frame; None if it is unknown or the fixed frame itself.
    """
    pose = pose or Pose()
    wxyz = Pose().wxyz
    if isinstance(view, FrameAligned):
        wxyz = pose.wxyz
    elif isinstance(view, ThirdPersonFollower):
        wxyz = from_rpy(0.0, 0.0, to_rpy(pose.wxyz)[2])
    if getattr(view, "invert_z_axis", False):
        wxyz = multiply(wxyz, UPSIDE_DOWN)
    return Rig(pose.position, wxyz)


def mimic(view: View, rig: Rig, other: View, new_rig: Rig, height_px: float) -> View:
    """Return a view of another type or target frame that shows nearly the same.

    Args:
        view: the current view.
        rig: its coordinates.
        other: has the type, target frame and options of the new view.
        new_rig: the coordinates of the new view.
        height_px: of the picture.
    """
    if type(view) is type(other):
        camera = camera_of(view, height_px)
        return view_of(other, new_rig.inward(rig.outward(camera)), height_px)
    return _fitted(other, new_rig.inward(rig.outward(_eye(view, height_px))), height_px)


def focus(
    view: View, rig: Rig, low: Vector, high: Vector, width_px: float, height_px: float
) -> View:
    """Return the view from the same direction that fits a box.

    Args:
        view: the current view.
        rig: of its target frame.
        low, high: corners of the box in the fixed frame, in metres.
        width_px, height_px: of the picture.
    """
    radius = max(float(np.linalg.norm(high - low)) / 2.0, SMALLEST)
    narrow = math.atan(math.tan(FIELD_OF_VIEW / 2.0) * min(1.0, width_px / height_px))
    eye = rig.outward(_eye(view, height_px))
    return _looking(
        view, rig, eye, (low + high) / 2.0, MARGIN * radius / math.sin(narrow), height_px
    )


def _looking(
    view: View, rig: Rig, eye: Camera, at: Vector, distance: float, height_px: float
) -> View:
    back = (eye.position - eye.look_at) / eye.distance
    camera = rig.inward(Camera(at + distance * back, at))
    return _fitted(view, camera, height_px)


def _eye(view: View, height_px: float) -> Camera:
    """Return a perspective camera that shows nearly the same as a view, with its focal point."""
    camera = camera_of(view, height_px)
    if isinstance(view, TopDownOrtho):
        distance = camera.distance * FLATTER
        yaw = view.angle - math.pi / 2
        level = math.cos(STEEPEST)
        back = (level * math.cos(yaw), level * math.sin(yaw), math.sin(STEEPEST))
        return Camera(camera.look_at + distance * np.array(back), camera.look_at)
    if isinstance(view, FPS):
        forward = (camera.look_at - camera.position) / camera.distance
        reach = -camera.position[2] / forward[2] if abs(forward[2]) > 1e-3 else -1.0
        reach = reach if 0.0 < reach < FARTHEST else REACH
        return Camera(camera.position, camera.position + reach * forward)
    return camera


def _fitted(view: View, eye: Camera, height_px: float) -> View:
    """Return the view of the same type and options that shows the same as a perspective camera."""
    back = (eye.position - eye.look_at) / eye.distance
    if isinstance(view, TopDownOrtho):
        level = math.hypot(back[0], back[1])
        yaw = math.atan2(back[1], back[0]) if level > 1e-6 else -math.pi / 2
        scale = height_px / 2.0 / math.tan(FIELD_OF_VIEW / 2.0) / eye.distance
        x, y = eye.look_at[:2].tolist()
        flat = TopDownOrtho(scale=min(max(scale, 1e-5), 1e6), angle=yaw + math.pi / 2, x=x, y=y)
        return view_of(view, camera_of(flat, height_px), height_px)
    raised = RAISED * math.hypot(back[0], back[1])
    if not isinstance(view, FPS | Orbit) and back[2] > 0.05 - raised:
        # Along the line of sight to where the focal point lies on the ground.
        step = (eye.look_at[2] - raised * eye.distance) / (back[2] + raised)
        # A camera on the ground would have no direction to its focal point.
        if NEAREST * eye.distance < eye.distance + step < FARTHEST:
            eye = Camera(eye.position, eye.look_at - step * back)
    return view_of(view, eye, height_px)
