"""Grid and Axes as people see them."""

from __future__ import annotations

from collections.abc import Callable

from webviz.api.views import Orbit
from webviz.shell.testing import Harness, turned
from webviz_displays.axes import Axes
from webviz_displays.grid import Grid

Stages = Callable[..., Harness]


def test_a_grid_has_cells_lines_and_a_plane(webviz_harness: Stages) -> None:
    harness = webviz_harness(Grid(), view=Orbit(distance=17.0, yaw=-1.2, pitch=0.6))
    harness.check_picture("grid/default")
    harness.set("line_style", "Billboards")
    harness.set("line_width", 0.15)
    harness.set("color", (90, 160, 255))
    harness.set("alpha", 1.0)
    harness.check_picture("grid/billboards")
    harness.set("plane_cell_count", 3)
    harness.set("cell_size", 2.0)
    harness.set("plane", "XZ")
    harness.check_picture("grid/plane_xz")
    harness.set("line_style", "Lines")
    harness.set("normal_cell_count", 2)
    harness.set("offset", (0.0, 0.0, 2.0))
    harness.check_picture("grid/normal_cells")


def test_a_grid_lies_in_its_reference_frame(webviz_harness: Stages) -> None:
    harness = webviz_harness(
        Grid(plane_cell_count=4), Axes(), view=Orbit(distance=9.0, yaw=-1.2, pitch=0.6)
    )
    harness.transform("map", "ramp", (1.5, 0.0, 0.5), turned(pitch=-0.4, yaw=0.6))
    harness.set("reference_frame", "ramp")
    harness.check_picture("grid/reference_frame")


def test_axes_have_a_length_a_radius_and_a_frame(webviz_harness: Stages) -> None:
    view = Orbit(distance=6.0, yaw=0.9, pitch=0.5)
    harness = webviz_harness(Axes(), Grid(), view=view)
    harness.check_picture("axes/default")
    harness = webviz_harness(Axes(length=2.0, radius=0.03), Grid(), view=view)
    harness.check_picture("axes/length_and_radius")
    harness.transform("map", "camera", (0.0, 0.0, 1.0), turned(roll=-1.5708, yaw=-1.0))
    harness.set("reference_frame", "camera")
    harness.check_picture("axes/reference_frame")
