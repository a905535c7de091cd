"""Odometry as people see it."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from webviz.api.views import Orbit
from webviz.shell.testing import Harness, turned
from webviz_displays.grid import Grid
from webviz_displays.odometry import Odometry
from webviz_displays.shared.pose_properties import Covariance, PoseShape

Stages = Callable[..., Harness]

ARROW = PoseShape(shaft_length=0.5, shaft_radius=0.03, head_length=0.2, head_radius=0.08)
NONE = Covariance(value=False)


def drive(harness: Harness, variances: tuple[float, ...], steps: int = 9) -> None:
    """A robot drives along an arc and gets less sure of where it is.

    Args:
        harness: where.
        variances: of x, y, z, roll, pitch, yaw at the end.
        steps: how many poses.
    """
    harness.transform("map", "elsewhere")
    for i in range(steps):
        angle = -1.2 + 2.0 * i / (steps - 1)
        x, y, z, w = turned(yaw=angle + math.pi / 2)
        pose = {
            "position": {"x": 2.2 * math.cos(angle) - 1.0, "y": 2.2 * math.sin(angle)},
            "orientation": {"x": x, "y": y, "z": z, "w": w},
        }
        grown = np.diag(variances) * (i + 1) / steps
        values = {"pose": {"pose": pose, "covariance": grown.ravel()}}
        harness.publish("/odom", "nav_msgs/msg/Odometry", values, frame="map")
    harness.turn()


def test_poses_are_arrows_or_axes_up_to_the_history_length(webviz_harness: Stages) -> None:
    view = Orbit(distance=5.5, yaw=-0.3, pitch=0.8, focal_point=(0.4, 0.0, 0.0))
    harness = webviz_harness(Odometry(covariance=NONE), Grid(plane_cell_count=6), view=view)
    drive(harness, (0.0,) * 6)
    harness.check_picture("odometry/without_covariance")
    harness.set("shape.shaft_length", 0.5)
    harness.set("shape.shaft_radius", 0.03)
    harness.set("shape.head_length", 0.2)
    harness.set("shape.head_radius", 0.08)
    harness.set("shape.color", (80, 200, 255))
    harness.check_picture("odometry/smaller_arrows")
    harness.set("shape.alpha", 0.4)
    harness.set("keep", 4)
    harness.check_picture("odometry/keep_4_faded_by_alpha")
    harness.set("shape.axes_length", 0.5)
    harness.set("shape.axes_radius", 0.04)
    harness.set("shape.value", "Axes")
    harness.check_picture("odometry/axes")


def test_covariances_in_the_plane_are_ellipses_and_wedges(webviz_harness: Stages) -> None:
    view = Orbit(distance=5.5, yaw=-0.3, pitch=0.9, focal_point=(0.4, 0.0, 0.0))
    harness = webviz_harness(Odometry(shape=ARROW), Grid(plane_cell_count=6), view=view)
    drive(harness, (0.03, 0.12, 0.0, 0.0, 0.0, 0.06), steps=5)
    harness.check_picture("odometry/default")
    harness.set("covariance.orientation.value", False)
    harness.set("covariance.position.scale", 2.0)
    harness.set("covariance.position.color", (80, 255, 120))
    harness.set("covariance.position.alpha", 0.6)
    harness.check_picture("odometry/position_covariance_of_2_sigma")
    harness.set("covariance.position.value", False)
    harness.set("covariance.orientation.value", True)
    harness.set("covariance.orientation.offset", 0.5)
    harness.set("covariance.orientation.color", (120, 200, 255))
    harness.check_picture("odometry/orientation_covariance_at_0.5_m")


def test_covariances_in_space_are_ellipsoids_and_discs(webviz_harness: Stages) -> None:
    view = Orbit(distance=5.0, yaw=-0.6, pitch=0.6, focal_point=(0.5, 1.2, 0.3))
    harness = webviz_harness(Odometry(shape=ARROW, keep=1), Grid(plane_cell_count=6), view=view)
    drive(harness, (0.05, 0.2, 0.1, 0.1, 0.05, 0.2), steps=6)
    harness.check_picture("odometry/default_in_space")
    harness.set("covariance.orientation.color_style", "RGB")
    harness.set("covariance.orientation.alpha", 1.0)
    harness.set("covariance.orientation.frame", "Fixed")
    harness.check_picture("odometry/color_style_rgb_in_the_fixed_frame")
