"""Poses of a camera for a view, and back."""

from __future__ import annotations

import math

import msgspec
import numpy as np
import pytest
from hypothesis import given
from views import VIEWS

from webviz.api.views import (
    FPS,
    Camera,
    Orbit,
    ThirdPersonFollower,
    TopDownOrtho,
    View,
    XYOrbit,
    camera_of,
    like,
    view_of,
)


@given(VIEWS)
def test_a_camera_gives_back_the_view_it_was_placed_for(view: View) -> None:
    again = view_of(like(type(view), view), camera_of(view, 600), 600)
    assert type(again) is type(view)
    for field in view.__struct_fields__:
        expected = getattr(view, field)
        if not isinstance(expected, str | bool):
            # A large picture at a small scale is taken from 300 km, which costs digits.
            assert getattr(again, field) == pytest.approx(expected, rel=1e-6, abs=2e-6), field


@pytest.mark.parametrize(
    ("view", "position", "forward"),
    [
        # RViz's formula: focal point + distance (cos yaw cos pitch, sin yaw cos pitch, sin pitch)
        (
            Orbit(distance=2.0, yaw=0.0, pitch=0.0, focal_point=(1.0, 0.0, 0.0)),
            (3, 0, 0),
            (-1, 0, 0),
        ),
        (Orbit(distance=2.0, yaw=math.pi / 2, pitch=0.0), (0, 2, 0), (0, -1, 0)),
        (Orbit(distance=2.0, yaw=0.0, pitch=math.pi / 6), (3**0.5, 0, 1), (-(3**0.5) / 2, 0, -0.5)),
        # The same, moved by a fifth of the distance along the camera's own up.
        (
            XYOrbit(distance=10.0, yaw=0.0, pitch=math.pi / 6),
            (75**0.5 - 1, 0, 5 + 3**0.5),
            (-(3**0.5) / 2, 0, -0.5),
        ),
        (XYOrbit(distance=10.0, yaw=0.0, pitch=0.0), (10, 0, 2), (-1, 0, 0)),
        (ThirdPersonFollower(distance=5.0, yaw=math.pi, pitch=0.0), (-5, 0, 1), (1, 0, 0)),
        # From where one stands, along x; a positive pitch looks down.
        (FPS(position=(1.0, 2.0, 3.0)), (1, 2, 3), (1, 0, 0)),
        (FPS(yaw=math.pi / 2, position=(0.0, 0.0, 0.0)), (0, 0, 0), (0, 1, 0)),
        (FPS(pitch=math.pi / 6, position=(0.0, 0.0, 0.0)), (0, 0, 0), (3**0.5 / 2, 0, -0.5)),
    ],
)
def test_cameras_stand_where_rviz_puts_them(
    view: View, position: tuple[float, ...], forward: tuple[float, ...]
) -> None:
    camera = camera_of(view, 600)
    np.testing.assert_allclose(camera.position, position, atol=1e-12)
    line = (camera.look_at - camera.position) / camera.distance
    np.testing.assert_allclose(line, forward, atol=1e-9)


def test_a_camera_for_a_view_from_above_is_over_its_middle_and_leans_to_where_up_is() -> None:
    camera = camera_of(TopDownOrtho(x=3.0, y=-2.0, angle=math.pi / 2), 600)
    np.testing.assert_allclose(camera.look_at, (3, -2, 0))
    back = (camera.position - camera.look_at) / camera.distance
    np.testing.assert_allclose(back, (1e-5, 0, 1), atol=1e-9)  # up in the picture is -x


def test_cameras_outside_the_limits_of_a_view_are_clamped() -> None:
    straight_down = Camera(np.array((0.0, 0.0, 5.0)), np.zeros(3))
    view = view_of(Orbit(), straight_down, 600)
    assert view.pitch == 1.5698
    msgspec.convert(msgspec.to_builtins(view), Orbit)  # it is valid
    on_the_spot = view_of(Orbit(), Camera(np.zeros(3), np.zeros(3)), 600)
    msgspec.convert(msgspec.to_builtins(on_the_spot), Orbit)
