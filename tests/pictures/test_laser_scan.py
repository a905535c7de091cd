"""LaserScan as people see it."""

from __future__ import annotations

from collections.abc import Callable

import building

from webviz.api.views import Orbit
from webviz.shell.testing import Harness, turned
from webviz.shell.testing.source import SECOND
from webviz_displays.axes import Axes
from webviz_displays.laser_scan import LaserScan
from webviz_sim.pose import Pose2D

Stages = Callable[..., Harness]

LASER = Pose2D(-2.0, 0.0, 0.3)
VIEW = Orbit(distance=13.5, yaw=-1.5708, pitch=1.2, focal_point=(0.0, -0.2, 0.0))


def send(harness: Harness, laser: Pose2D = LASER) -> None:
    """A scan of the building, by a laser 0.3 m above the floor."""
    harness.transform("map", "laser", (laser.x, laser.y, 0.3), turned(yaw=laser.yaw))
    harness.publish("/scan", "sensor_msgs/msg/LaserScan", building.scan(laser), frame="laser")
    harness.turn()


def axes() -> Axes:
    """Return where the laser is."""
    return Axes(reference_frame="laser", length=0.6, radius=0.04)


def test_points_have_styles_and_sizes(webviz_harness: Stages) -> None:
    harness = webviz_harness(LaserScan(size=0.1), axes(), view=VIEW)
    send(harness)
    harness.check_picture("laser_scan/default")
    harness.set("style", "Spheres")
    harness.set("size", 0.25)
    harness.check_picture("laser_scan/spheres")
    harness.set("style", "Boxes")
    harness.check_picture("laser_scan/boxes")
    harness.set("style", "Points")
    harness.set("size_pixels", 4.0)
    harness.check_picture("laser_scan/points")


def test_colours_follow_the_transformer(webviz_harness: Stages) -> None:
    harness = webviz_harness(LaserScan(size=0.12), axes(), view=VIEW)
    send(harness)
    harness.set("use_rainbow", False)
    harness.set("min_color", (0, 60, 255))
    harness.set("max_color", (255, 230, 0))
    harness.check_picture("laser_scan/intensity_min_to_max_color")
    harness.set("channel_name", "range")
    harness.set("use_rainbow", True)
    harness.check_picture("laser_scan/channel_range")
    harness.set("color_transformer", "AxisColor")
    harness.set("axis", "X")
    harness.check_picture("laser_scan/axis_x")
    harness.set("use_fixed_frame", False)
    harness.set("axis", "Y")
    harness.set("autocompute_value_bounds.value", False)
    harness.set("autocompute_value_bounds.min_value", -1.0)
    harness.set("autocompute_value_bounds.max_value", 1.0)
    harness.check_picture("laser_scan/axis_y_of_the_laser_from_-1_to_1")
    harness.set("color_transformer", "FlatColor")
    harness.set("color", (255, 80, 160))
    harness.set("alpha", 0.4)
    harness.check_picture("laser_scan/flat_color_faded_by_alpha")


def test_scans_stay_for_the_decay_time(webviz_harness: Stages) -> None:
    harness = webviz_harness(
        LaserScan(size=0.08, decay_time=2.0, color_transformer="FlatColor"), view=VIEW
    )
    for laser in (Pose2D(-4.0, 2.5), Pose2D(0.0, 0.0), Pose2D(4.0, -2.0)):
        harness.transform("map", "laser", (laser.x, laser.y, 0.3), stamp_ns=harness.source.now)
        harness.publish("/scan", "sensor_msgs/msg/LaserScan", building.scan(laser), frame="laser")
        harness.turn()
        harness.source.now += SECOND
    harness.source.now -= SECOND
    harness.check_picture("laser_scan/decay_time_2_s")
    harness.set("decay_time", 0.0)
    harness.check_picture("laser_scan/decay_time_0")
