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


def send(seen: Harness, height: float) -> None:
    """A path like a wave, `height` metres high."""
    x = np.linspace(-2.5, 2.5, 14)
    seen.transform("map", "elsewhere")
    points = np.column_stack([x, height * np.sin(2.0 * x)])
    seen.publish("/path", "nav_msgs/msg/Path", building.path(points), frame="map")
    seen.turn()


def test_a_path_has_a_line_and_poses(webviz_harness: Stages) -> None:
    seen = webviz_harness(Path(), Grid(plane_cell_count=6), view=VIEW)
    send(seen, 1.0)
    seen.check_picture("path/default")
    seen.set("line_style", "Billboards")
    seen.set("line_width", 0.12)
    seen.set("color", (255, 160, 0))
    seen.check_picture("path/billboards")
    seen.set("alpha", 0.4)
    seen.set("length", 0.4)
    seen.set("pose_style", "Axes")
    seen.check_picture("path/axes_on_a_faded_line")
    seen.set("pose_style", "Arrows")
    seen.set("line_style", "Lines")
    seen.check_picture("path/arrows")
    seen.set("alpha", 1.0)
    seen.set("shaft_diameter", 0.05)
    seen.set("head_diameter", 0.15)
    seen.set("pose_color", (80, 220, 255))
    seen.set("offset", (0.0, 0.0, 1.0))
    seen.check_picture("path/thinner_arrows_offset_1_m_up")


def test_the_newest_paths_stay(webviz_harness: Stages) -> None:
    seen = webviz_harness(Path(buffer_length=3), Grid(plane_cell_count=6), view=VIEW)
    for height in (2.0, 1.4, 0.8, 0.2):
        send(seen, height)
    seen.check_picture("path/buffer_length_3")
    seen.set("buffer_length", 1)
    seen.check_picture("path/buffer_length_1")
