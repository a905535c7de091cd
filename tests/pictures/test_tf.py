"""TF as people see it."""

from __future__ import annotations

from collections.abc import Callable

from webviz import Level
from webviz.api.views import Orbit
from webviz.shell.testing import Harness, turned
from webviz.shell.testing.source import SECOND
from webviz_displays.grid import Grid
from webviz_displays.tf import TF

Stages = Callable[..., Harness]


def frames(harness: Harness, stamp_ns: int) -> None:
    """A robot that moves, with what is fixed to it, and a dock that stands still."""
    harness.transform("map", "dock", (1.0, 0.8, 0.0), turned(yaw=2.2))
    harness.transform("map", "base", (0.3, -0.6, 0.0), turned(yaw=0.5), stamp_ns=stamp_ns)
    harness.transform("base", "mast", (-0.2, 0.0, 0.7))
    harness.transform("mast", "camera", (0.3, 0.0, 0.2), turned(roll=-1.5708, yaw=-1.5708))
    harness.turn()


def test_frames_have_axes_arrows_and_names(webviz_harness: Stages) -> None:
    view = Orbit(distance=2.9, yaw=-0.9, pitch=0.5, focal_point=(0.5, 0.0, 0.3))
    harness = webviz_harness(TF(), Grid(plane_cell_count=4), view=view)
    frames(harness, harness.source.now)
    harness.check_picture("tf/default")
    harness.set("show_names", True)
    harness.check_picture("tf/names")
    harness.set("show_axes", False)
    harness.set("marker_scale", 1.5)
    harness.set("show_arrows", False)
    harness.set("show_axes", True)
    harness.check_picture("tf/marker_scale_without_arrows")
    harness.set("filter_blacklist", "ma[ps]")
    harness.check_picture("tf/filter_blacklist")
    harness.set("filter_blacklist", "")
    harness.set("show_axes", False)
    harness.set("show_arrows", True)
    harness.check_picture("tf/arrows_and_names")


def test_frames_that_are_not_updated_turn_grey_and_disappear(webviz_harness: Stages) -> None:
    view = Orbit(distance=2.9, yaw=-0.9, pitch=0.5, focal_point=(0.5, 0.0, 0.3))
    harness = webviz_harness(TF(marker_scale=2.0), Grid(plane_cell_count=4), view=view)
    frames(harness, harness.source.now)
    harness.source.now += 10 * SECOND
    harness.check_picture("tf/old_frames_are_grey")
    harness.source.now += 6 * SECOND
    harness.check_picture("tf/older_frames_are_gone")
    frames_status = harness.statuses()["Frames"]
    assert frames_status.level is Level.WARN
    assert "3 not updated for more than 15 s" in frames_status.text
