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


def send(seen: Harness, laser: Pose2D = LASER) -> None:
    """A scan of the building, by a laser 0.3 m above the floor."""
    seen.transform("map", "laser", (laser.x, laser.y, 0.3), turned(yaw=laser.yaw))
    seen.publish("/scan", "sensor_msgs/msg/LaserScan", building.scan(laser), frame="laser")
    seen.turn()


def axes() -> Axes:
    """Return where the laser is."""
    return Axes(reference_frame="laser", length=0.6, radius=0.04)


def test_points_have_styles_and_sizes(webviz_harness: Stages) -> None:
    seen = webviz_harness(LaserScan(size=0.1), axes(), view=VIEW)
    send(seen)
    seen.check_picture("laser_scan/default")
    seen.set("style", "Spheres")
    seen.set("size", 0.25)
    seen.check_picture("laser_scan/spheres")
    seen.set("style", "Boxes")
    seen.check_picture("laser_scan/boxes")
    seen.set("style", "Points")
    seen.set("size_pixels", 4.0)
    seen.check_picture("laser_scan/points")


def test_colours_follow_the_transformer(webviz_harness: Stages) -> None:
    seen = webviz_harness(LaserScan(size=0.12), axes(), view=VIEW)
    send(seen)
    seen.set("use_rainbow", False)
    seen.set("min_color", (0, 60, 255))
    seen.set("max_color", (255, 230, 0))
    seen.check_picture("laser_scan/intensity_min_to_max_color")
    seen.set("channel_name", "range")
    seen.set("use_rainbow", True)
    seen.check_picture("laser_scan/channel_range")
    seen.set("color_transformer", "AxisColor")
    seen.set("axis", "X")
    seen.check_picture("laser_scan/axis_x")
    seen.set("use_fixed_frame", False)
    seen.set("axis", "Y")
    seen.set("autocompute_value_bounds.value", False)
    seen.set("autocompute_value_bounds.min_value", -1.0)
    seen.set("autocompute_value_bounds.max_value", 1.0)
    seen.check_picture("laser_scan/axis_y_of_the_laser_from_-1_to_1")
    seen.set("color_transformer", "FlatColor")
    seen.set("color", (255, 80, 160))
    seen.set("alpha", 0.4)
    seen.check_picture("laser_scan/flat_color_faded_by_alpha")


def test_scans_stay_for_the_decay_time(webviz_harness: Stages) -> None:
    seen = webviz_harness(
        LaserScan(size=0.08, decay_time=2.0, color_transformer="FlatColor"), view=VIEW
    )
    for laser in (Pose2D(-4.0, 2.5), Pose2D(0.0, 0.0), Pose2D(4.0, -2.0)):
        seen.transform("map", "laser", (laser.x, laser.y, 0.3), stamp_ns=seen.source.now)
        seen.publish("/scan", "sensor_msgs/msg/LaserScan", building.scan(laser), frame="laser")
        seen.turn()
        seen.source.now += SECOND
    seen.source.now -= SECOND
    seen.check_picture("laser_scan/decay_time_2_s")
    seen.set("decay_time", 0.0)
    seen.check_picture("laser_scan/decay_time_0")
