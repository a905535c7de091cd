"""A real TurtleBot 4 in its mapped corridor, shown with the settings of its own RViz config."""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np
import PIL.Image
from turtlebot import MAP, ORIGIN, RESOLUTION, START, messages, needs_bag, needs_map

from webviz import Level
from webviz.api.views import Orbit
from webviz.shell.testing import Harness
from webviz_displays.grid import Grid
from webviz_displays.laser_scan import LaserScan
from webviz_displays.map import Map
from webviz_displays.odometry import Odometry
from webviz_displays.shared.pose_properties import Covariance

OCCUPIED, FREE = 90, 190
"""Grey at most and at least, by occupied_thresh 0.65 and free_thresh 0.25 of its .yaml."""
SCANS = 60

pytestmark = [needs_bag, needs_map]


def cells() -> np.ndarray:
    """int8 (height, width), as map_server reads a trinary picture; its last row comes first."""
    picture = np.flipud(np.asarray(PIL.Image.open(MAP)))
    read = np.where(picture <= OCCUPIED, 100, np.where(picture >= FREE, 0, -1))
    return read.astype(np.int8)


def test_the_scan_lies_on_the_walls_of_the_map(webviz_harness: Callable[..., Harness]) -> None:
    grid = cells()
    height, width = grid.shape
    x, y = ORIGIN
    origin = {"position": {"x": x, "y": y}, "orientation": {"w": 1.0}}
    info = {"resolution": RESOLUTION, "width": width, "height": height, "origin": origin}
    odometry = Odometry(keep=1, covariance=Covariance(value=False))
    view = Orbit(distance=16.0, yaw=-1.5708, pitch=1.3, focal_point=(6.0, -9.0, 0.0))
    harness = webviz_harness(Grid(), LaserScan(size=0.05), odometry, Map(), view=view)
    harness.transform("map", "odom", *START)
    map_ = {"info": info, "data": grid.ravel()}
    harness.publish("/map", "nav_msgs/msg/OccupancyGrid", map_, frame="map")
    scans = itertools.count(1)
    for topic, type_name, time_ns, data in messages("/tf", "/tf_static", "/scan", "/odom"):
        harness.source.now = time_ns
        harness.publish_bytes(topic, type_name, data)
        harness.turn()
        if topic == "/scan" and next(scans) == SCANS:
            break
    harness.check_picture("real_robot/scan_on_walls")
    assert harness.statuses("LaserScan")["Points"].level is Level.OK
