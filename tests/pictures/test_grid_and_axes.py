"""Grid and Axes as people see them."""

from __future__ import annotations

from collections.abc import Callable

from webviz.api.views import Orbit
from webviz.shell.testing import Harness, turned
from webviz_displays.axes import Axes
from webviz_displays.grid import Grid

Stages = Callable[..., Harness]


def test_a_grid_has_cells_lines_and_a_plane(webviz_harness: Stages) -> None:
    seen = webviz_harness(Grid(), view=Orbit(distance=17.0, yaw=-1.2, pitch=0.6))
    seen.check_picture("grid/default")
    seen.set("line_style", "Billboards")
    seen.set("line_width", 0.15)
    seen.set("color", (90, 160, 255))
    seen.set("alpha", 1.0)
    seen.check_picture("grid/billboards")
    seen.set("plane_cell_count", 3)
    seen.set("cell_size", 2.0)
    seen.set("plane", "XZ")
    seen.check_picture("grid/plane_xz")
    seen.set("line_style", "Lines")
    seen.set("normal_cell_count", 2)
    seen.set("offset", (0.0, 0.0, 2.0))
    seen.check_picture("grid/normal_cells")


def test_a_grid_lies_in_its_reference_frame(webviz_harness: Stages) -> None:
    seen = webviz_harness(
        Grid(plane_cell_count=4), Axes(), view=Orbit(distance=9.0, yaw=-1.2, pitch=0.6)
    )
    seen.transform("map", "ramp", (1.5, 0.0, 0.5), turned(pitch=-0.4, yaw=0.6))
    seen.set("reference_frame", "ramp")
    seen.check_picture("grid/reference_frame")


def test_axes_have_a_length_a_radius_and_a_frame(webviz_harness: Stages) -> None:
    view = Orbit(distance=6.0, yaw=0.9, pitch=0.5)
    seen = webviz_harness(Axes(), Grid(), view=view)
    seen.check_picture("axes/default")
    seen = webviz_harness(Axes(length=2.0, radius=0.03), Grid(), view=view)
    seen.check_picture("axes/length_and_radius")
    seen.transform("map", "camera", (0.0, 0.0, 1.0), turned(roll=-1.5708, yaw=-1.0))
    seen.set("reference_frame", "camera")
    seen.check_picture("axes/reference_frame")
