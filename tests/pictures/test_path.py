"""Path as people see it."""

from __future__ import annotations

from collections.abc import Callable

import building
import numpy as np

from webviz.api.views import Orbit
from webviz.shell.testing import Harness
from webviz_displays.grid import Grid
from webviz_displays.path import Path

Stages = Callable[..., Harness]

VIEW = Orbit(distance=6.5, yaw=-1.3, pitch=0.9)


def send(harness: Harness, height: float) -> None:
    """A path like a wave, `height` metres high."""
    x = np.linspace(-2.5, 2.5, 14)
    harness.transform("map", "elsewhere")
    points = np.column_stack([x, height * np.sin(2.0 * x)])
    harness.publish("/path", "nav_msgs/msg/Path", building.path(points), frame="map")
    harness.turn()


def test_a_path_has_a_line_and_poses(webviz_harness: Stages) -> None:
    harness = webviz_harness(Path(), Grid(plane_cell_count=6), view=VIEW)
    send(harness, 1.0)
    harness.check_picture("path/default")
    harness.set("line_style", "Billboards")
    harness.set("line_width", 0.12)
    harness.set("color", (255, 160, 0))
    harness.check_picture("path/billboards")
    harness.set("alpha", 0.4)
    harness.set("length", 0.4)
    harness.set("pose_style", "Axes")
    harness.check_picture("path/axes_on_a_faded_line")
    harness.set("pose_style", "Arrows")
    harness.set("line_style", "Lines")
    harness.check_picture("path/arrows")
    harness.set("alpha", 1.0)
    harness.set("shaft_diameter", 0.05)
    harness.set("head_diameter", 0.15)
    harness.set("pose_color", (80, 220, 255))
    harness.set("offset", (0.0, 0.0, 1.0))
    harness.check_picture("path/thinner_arrows_offset_1_m_up")


def test_the_newest_paths_stay(webviz_harness: Stages) -> None:
    harness = webviz_harness(Path(buffer_length=3), Grid(plane_cell_count=6), view=VIEW)
    for height in (2.0, 1.4, 0.8, 0.2):
        send(harness, height)
    harness.check_picture("path/buffer_length_3")
    harness.set("buffer_length", 1)
    harness.check_picture("path/buffer_length_1")
