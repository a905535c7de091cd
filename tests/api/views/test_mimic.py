"""Another type, target frame or box: what is looked at stays, or comes into the middle."""

from __future__ import annotations

import math
from typing import Any

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from views import ALIGNED_VIEWS, FLAT_VIEWS, FPS_VIEWS, ORBITS, PITCHES

from webviz.api.nodes import Pose
from webviz.api.views import (
    FIELD_OF_VIEW,
    FPS,
    Camera,
    FrameAligned,
    Orbit,
    Rig,
    ThirdPersonFollower,
    TopDownOrtho,
    View,
    XYOrbit,
    camera_of,
    focus,
    like,
    mimic,
    rig_of,
    zero,
)
from webviz.data.rotations import from_rpy, matrices

HOME = Rig()
HEIGHT, WIDTH = 600.0, 800.0
RIGS = st.builds(
    Rig,
    st.tuples(st.floats(-100, 100), st.floats(-100, 100), st.floats(-5, 5)),
    st.floats(-3.0, 3.0).map(lambda yaw: from_rpy(0.0, 0.0, yaw)),
)


def seen_as(view: View, cls: type[Any]) -> Any:
    other = like(cls, view)
    return mimic(view, rig_of(view, None), other, rig_of(other, None), HEIGHT)


def camera_at(view: View) -> Camera:
    """Return the camera of a view in the fixed frame."""
    return rig_of(view, None).outward(camera_of(view, HEIGHT))


def same_picture(a: Camera, b: Camera) -> bool:
    """Return whether two cameras stand in one place and look in one direction."""
    lines = [(c.look_at - c.position) / c.distance for c in (a, b)]
    return np.allclose(a.position, b.position, atol=1e-3) and np.allclose(*lines, atol=1e-4)


@given(ORBITS)
def test_orbit_and_fps_show_the_same_picture(view: Orbit) -> None:
    fps = seen_as(view, FPS)
    assert isinstance(fps, FPS)
    assert same_picture(camera_at(fps), camera_at(view))


@given(st.floats(1, 500), st.floats(0.1, 1.5), st.floats(-9, 9))
def test_a_view_of_the_ground_comes_back_from_fps(distance: float, pitch: float, x: float) -> None:
    view = Orbit(distance=distance, yaw=1.0, pitch=pitch, focal_point=(x, -x, 0.0))
    again = seen_as(seen_as(view, FPS), Orbit)
    assert again.distance == pytest.approx(view.distance, rel=1e-3)
    assert again.focal_point == pytest.approx(view.focal_point, abs=view.distance * 1e-3)


@given(ORBITS)
def test_xy_orbit_shows_the_same_picture_with_its_focal_point_on_the_ground(view: Orbit) -> None:
    xy = seen_as(view, XYOrbit)
    assert isinstance(xy, XYOrbit)
    assert same_picture(camera_at(xy), camera_at(view))


def test_the_focal_point_of_xy_orbit_is_on_the_ground() -> None:
    xy = seen_as(Orbit(focal_point=(3.0, 1.0, 0.5)), XYOrbit)
    assert xy.focal_point[2] == pytest.approx(0.0, abs=1e-6)


@given(ORBITS)
def test_from_above_the_focal_point_stays_in_the_middle_and_as_large(view: Orbit) -> None:
    flat = seen_as(view, TopDownOrtho)
    assert (flat.x, flat.y) == pytest.approx(view.focal_point[:2], abs=1e-5)
    meters = 2 * view.distance * math.tan(FIELD_OF_VIEW / 2)
    assert flat.scale == pytest.approx(HEIGHT / meters, abs=1e-5)


@given(FLAT_VIEWS)
def test_a_view_from_above_goes_to_orbit_and_back(view: TopDownOrtho) -> None:
    again = seen_as(seen_as(view, Orbit), TopDownOrtho)
    assert (again.x, again.y) == pytest.approx((view.x, view.y), abs=1e-5)
    assert again.scale == pytest.approx(view.scale, rel=1e-4)
    assert math.cos(again.angle - view.angle) == pytest.approx(1.0, abs=1e-6)


def test_up_in_the_picture_stays_up_from_above() -> None:
    # Orbit from the south (yaw -90 degrees) has north up, which is angle 0 from above.
    assert seen_as(Orbit(yaw=-math.pi / 2), TopDownOrtho).angle == pytest.approx(0.0, abs=1e-6)


@given(st.one_of(ORBITS, FPS_VIEWS), RIGS, RIGS)
def test_another_target_frame_leaves_the_camera_where_it_is(view: View, a: Rig, b: Rig) -> None:
    follower = mimic(view, a, like(type(view), view, "other"), b, HEIGHT)
    assert follower.target_frame == "other"
    before, after = a.outward(camera_of(view, HEIGHT)), b.outward(camera_of(follower, HEIGHT))
    assert same_picture(before, after)


def test_views_rotate_with_their_frame_as_in_rviz() -> None:
    pose = Pose((1.0, 2.0, 3.0), from_rpy(0.0, 0.0, 0.6))
    assert rig_of(ThirdPersonFollower(), pose).wxyz == pytest.approx(pose.wxyz)
    assert rig_of(Orbit(), pose) == Rig((1.0, 2.0, 3.0))
    assert rig_of(Orbit(), None) == Rig()
    rolled = Pose(wxyz=from_rpy(0.6, 0.0, 0.0))
    assert rig_of(ThirdPersonFollower(), rolled).wxyz == pytest.approx((1.0, 0.0, 0.0, 0.0))
    assert rig_of(FrameAligned(), rolled).wxyz == rolled.wxyz


@given(ORBITS)
def test_an_inverted_orbit_is_where_rviz_puts_it(view: Orbit) -> None:
    """RViz negates yaw and pitch and keeps the focal point."""
    inverted = msgspec.structs.replace(view, invert_z_axis=True)
    mirrored = msgspec.structs.replace(view, yaw=-view.yaw, pitch=-view.pitch, invert_z_axis=False)
    assert same_picture(camera_at(inverted), camera_at(mirrored))


@given(ALIGNED_VIEWS, st.floats(-3.0, 3.0), st.floats(-1.5, 1.5))
def test_an_aligned_view_is_fixed_in_its_frame(
    view: FrameAligned, roll: float, pitch: float
) -> None:
    pose = Pose((1.0, 2.0, 3.0), from_rpy(roll, pitch, 0.5))
    at = rig_of(view, pose).outward(camera_of(view, HEIGHT)).position
    inside = matrices(pose.wxyz).T @ (at - pose.position)
    sign = -1.0 if view.invert_z_axis else 1.0
    assert inside == pytest.approx(np.array(view.position) * (1.0, sign, sign), abs=1e-6)


@pytest.mark.parametrize("is_inverted", [False, True])
@pytest.mark.parametrize(
    ("axis", "forward"),
    [
        ("+x", (1, 0, 0)),
        ("-x", (-1, 0, 0)),
        ("+y", (0, 1, 0)),
        ("-y", (0, -1, 0)),
        ("+z", (0, 0, 1)),
        ("-z", (0, 0, -1)),
    ],
)
def test_an_aligned_view_begins_5_m_behind_its_frame_along_an_axis(
    axis: str, forward: tuple[float, ...], is_inverted: bool
) -> None:
    values = {"type": "FrameAligned", "point_towards": f"{axis} axis", "invert_z_axis": is_inverted}
    view = zero(msgspec.convert(values | {"position": (1, 2, 3), "lock_camera": True}, View))
    assert isinstance(view, FrameAligned)
    assert (view.lock_camera, view.invert_z_axis) == (True, is_inverted)
    camera = camera_at(view)
    assert camera.position == pytest.approx(-5.0 * np.array(forward), abs=1e-5)
    line = (camera.look_at - camera.position) / camera.distance
    assert line == pytest.approx(np.array(forward), abs=2e-3)


BOXES = st.tuples(
    st.tuples(st.floats(-50, 50), st.floats(-50, 50), st.floats(0, 5)),
    st.tuples(st.floats(0.1, 20), st.floats(0.1, 20), st.floats(0.1, 5)),
)


@given(st.one_of(ORBITS, FPS_VIEWS), RIGS, BOXES)
def test_a_box_in_focus_is_all_in_the_picture(view: View, rig: Rig, box: Any) -> None:
    low, size = np.array(box[0]), np.array(box[1])
    focused = focus(view, rig, low, low + size, WIDTH, HEIGHT)
    camera = rig.outward(camera_of(focused, HEIGHT))
    forward = (camera.look_at - camera.position) / camera.distance
    right = np.cross(forward, (0.0, 0.0, 1.0))
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    half = math.tan(FIELD_OF_VIEW / 2)
    for corner in np.ndindex(2, 2, 2):
        ray = low + size * corner - camera.position
        depth = ray @ forward
        assert depth > 0
        assert abs(ray @ up / depth) <= half
        assert abs(ray @ right / depth) <= half * WIDTH / HEIGHT


@given(PITCHES)
def test_focus_keeps_the_direction(pitch: float) -> None:
    view = focus(Orbit(yaw=1.0, pitch=pitch), HOME, np.zeros(3), np.ones(3), WIDTH, HEIGHT)
    assert isinstance(view, Orbit)
    assert (view.yaw, view.pitch) == pytest.approx((1.0, pitch), abs=1e-5)
    assert view.focal_point == pytest.approx((0.5, 0.5, 0.5), abs=1e-5)


def test_a_box_from_above_fits_the_shorter_side() -> None:
    view = focus(TopDownOrtho(angle=0.7), HOME, np.zeros(3), np.array((4.0, 3.0, 0.0)), 300, 600)
    assert isinstance(view, TopDownOrtho)
    assert (view.x, view.y, view.angle) == pytest.approx((2.0, 1.5, 0.7), abs=1e-5)
    assert 250 <= view.scale * 5.0 <= 300  # its diagonal, in px


def test_a_camera_on_the_ground_keeps_its_direction_in_xy_orbit() -> None:
    view = Orbit(distance=372.162088, yaw=1.0, pitch=0.0, focal_point=(0.0, 0.0, 0.0))
    assert same_picture(camera_of(seen_as(view, XYOrbit), HEIGHT), camera_of(view, HEIGHT))
