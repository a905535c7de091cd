"""The faults that every course on ROS begins with: what they look like, and who names the cause."""

from __future__ import annotations

import math
from collections.abc import Callable

import building
from robots import DEMO, place_links

from webviz import Level, Status
from webviz.api.views import Orbit
from webviz.shell.testing import Harness, turned
from webviz.shell.testing.source import SECOND
from webviz_displays.laser_scan import LaserScan
from webviz_displays.map import Map
from webviz_displays.path import Path
from webviz_displays.robot_model import RobotModel
from webviz_displays.tf import TF
from webviz_sim.planner import Planner
from webviz_sim.pose import Pose2D

Stages = Callable[..., Harness]

VIEW = Orbit(distance=11.0, yaw=-1.5708, pitch=1.15, focal_point=(0.0, -0.2, 0.0))
START = Pose2D(-2.0, 0.0)
"""Pose at which the robot was switched on: in the corridor."""


def displays() -> tuple[Map, RobotModel, LaserScan, TF]:
    """Return the displays every story has in its list; TF tells where two frames are."""
    scan = LaserScan(size=0.08, color_transformer="FlatColor", color=(255, 40, 40))
    frames = TF(marker_scale=2.0, all_enabled=False, frames={"odom": True, "base_scan": True})
    return Map(), RobotModel(), scan, frames


def robot(harness: Harness, odom: Pose2D = START, laser_yaw: float = 0.0) -> None:
    """The demo robot with its map, its laser and its description.

    Args:
        harness: where.
        odom: the published pose of odom in map.
        laser_yaw: the published direction of the laser on the robot.
    """
    harness.transform("map", "odom", (odom.x, odom.y, 0.0), turned(yaw=odom.yaw))
    harness.transform("odom", "base_link", stamp_ns=harness.source.now)
    place_links(harness, DEMO, below="base_link")
    harness.transform("base_link", "base_scan", (0.0, 0.0, 0.2), turned(yaw=laser_yaw))
    harness.publish("/map", "nav_msgs/msg/OccupancyGrid", building.grid(), frame="map")
    harness.publish("/robot_description", "std_msgs/msg/String", {"data": DEMO.read_text()})
    look_around(harness)


def look_around(harness: Harness) -> None:
    """A scan from where the robot really is."""
    measured = building.scan(START)
    harness.clock += 1.0
    harness.publish("/scan", "sensor_msgs/msg/LaserScan", measured, frame="base_scan")
    harness.turn()


def test_a_robot_misplaced_by_a_static_transform(webviz_harness: Stages) -> None:
    harness = webviz_harness(*displays(), view=VIEW)
    robot(harness, odom=Pose2D(START.y, START.x))  # x and y are exchanged
    harness.check_picture("stories/misplaced")
    assert harness.statuses("TF")["odom"] == Status(
        Level.OK,
        "In 'map' (static): position (0.000, -2.000, 0.000) m, "
        "roll, pitch and yaw (0.0, 0.0, 0.0) degrees.",
    )
    status = harness.statuses("LaserScan")["Map"]
    assert status.level is Level.WARN
    assert "a shift by (-2.0, 2.0) m" in status.text
    harness.transform("map", "odom", (START.x, START.y, 0.0))
    look_around(harness)
    harness.check_picture("stories/in_place")
    assert "position (-2.000, 0.000, 0.000) m" in harness.statuses("TF")["odom"].text


def test_a_laser_turned_on_the_robot(webviz_harness: Stages) -> None:
    harness = webviz_harness(*displays(), view=VIEW)
    robot(harness, laser_yaw=math.radians(15))
    harness.check_picture("stories/turned_laser")
    text = harness.statuses("TF")["base_scan"].text
    assert text.startswith("In 'base_link' (static)")
    assert "yaw (0.0, 0.0, 15.0) degrees" in text
    status = harness.statuses("LaserScan")["Map"]
    assert status.level is Level.WARN
    assert "rotating 'base_scan' by -15°" in status.text
    # None is missing: one is wrong.
    assert harness.statuses("LaserScan")["Transform"] == Status(Level.OK, "Transform OK")


def test_a_path_that_leads_through_an_obstacle(webviz_harness: Stages) -> None:
    map_, model, scan, _ = displays()
    path = Path(line_style="Billboards", line_width=0.06)
    harness = webviz_harness(map_, model, scan, path, view=VIEW)
    goal = Pose2D(4.5, 0.0)
    plan = Planner(building.WORLD).plan(START, goal)
    robot(harness)
    harness.publish("/path", "nav_msgs/msg/Path", building.path(plan), frame="map")
    harness.turn()

    world = building.with_box(1.5, 0.0, 0.8)
    harness.source.now += 8 * SECOND
    harness.clock += 8.0
    harness.transform("odom", "base_link", stamp_ns=harness.source.now)
    measured = building.scan(START, world)
    harness.publish("/scan", "sensor_msgs/msg/LaserScan", measured, frame="base_scan")
    harness.turn()
    harness.check_picture("stories/through_an_obstacle")
    assert "the newest 8.0 s ago" in harness.statuses("Path")["Topic"].text  # the plan
    assert (
        "is 8.0 s old: the planner has not replanned" in harness.statuses("Path")["Obstacles"].text
    )
    assert "the newest 0.0 s ago" in harness.statuses("LaserScan")["Topic"].text  # the scan

    around = Planner(world).plan(START, goal)
    harness.publish("/path", "nav_msgs/msg/Path", building.path(around), frame="map")
    harness.turn()
    harness.check_picture("stories/around_the_obstacle")
