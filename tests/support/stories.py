"""Bags of the three faults that every course on ROS begins with, and of the repaired robots."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal

import building
from bags import START_NS, TF, Bag, ns

from webviz.shell.testing import header, turned
from webviz.shell.testing.messages import stamped_transform
from webviz_sim.pose import Pose2D

Fault = Literal["turned", "misplaced", "obstacle", "none"]
SECONDS = 6
HERE = Pose2D(-2.0, 0.0)
"""Pose of the robot."""
BOX = 0.6
"""Edge of a box that the planner does not know, in metres."""


def _transform(parent: str, child: str, at_s: float, pose: Pose2D, z: float = 0.0) -> Any:
    at_ns = START_NS + ns(at_s)
    return stamped_transform(parent, child, at_ns, (pose.x, pose.y, z), turned(yaw=pose.yaw))


def write(path: Path, fault: Fault, more: Mapping[float, str] | None = None) -> Path:
    """Write a bag of a robot that stands in the corridor.

    Args:
        path: of the folder.
        fault: its laser is turned, it is drawn in the wrong place, or its path leads through a box.
        more: lines of /rosout by their time.
    """
    bag = Bag()
    bag.add("/tf_static", TF, latched=True)
    bag.add("/tf", TF)
    bag.add("/map", "nav_msgs/msg/OccupancyGrid", latched=True)
    bag.add("/scan", "sensor_msgs/msg/LaserScan", best_effort=True)
    bag.add("/plan", "nav_msgs/msg/Path", latched=True)
    bag.add("/rosout", "rcl_interfaces/msg/Log")
    odom = Pose2D(HERE.y, HERE.x) if fault == "misplaced" else HERE
    laser = Pose2D(0.0, 0.0, 0.3 if fault == "turned" else 0.0)
    static = [
        _transform("map", "odom", 0.0, odom),
        _transform("base_link", "base_scan", 0.0, laser, 0.2),
    ]
    bag.put(0.0, "/tf_static", {"transforms": static})
    bag.put(0.0, "/map", building.grid() | {"header": header("map", START_NS)})
    way = building.path([(x / 4, 0.0) for x in range(-8, 9)])
    bag.put(0.0, "/plan", way | {"header": header("map", START_NS)})
    world = building.with_box(0.0, 0.0, BOX) if fault == "obstacle" else building.WORLD
    scan = building.scan(HERE, world)
    for step in range(10 * SECONDS + 1):
        at_s = step / 10
        moving = _transform("odom", "base_link", at_s, Pose2D(0.0, 0.0))
        bag.put(at_s, "/tf", {"transforms": [moving]})
        if step % 5 == 0:
            bag.put(at_s, "/scan", scan | {"header": header("base_scan", START_NS + ns(at_s))})
    for at_s, text in (more or {}).items():
        bag.put(at_s, "/rosout", {"level": 40, "name": "driver", "msg": text})
    return bag.write(path)


CONFIG = """\
version: 1
fixed_frame: map
displays:
- {type: Map}
- {type: LaserScan, name: Scan}
- {type: Path, topic: /plan}
- {type: TF}
"""
