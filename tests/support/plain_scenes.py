"""Messages for the displays of poses, areas, vectors and single measurements.

In each scene every property of the display has something to change.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from webviz.shell.testing import DisplayBench

ROBOT = """
<robot name="one">
  <link name="base"/>
  <link name="rider"/>
  <joint name="slide" type="continuous">
    <parent link="base"/><child link="rider"/><axis xyz="1 2 3"/>
    <limit effort="1" velocity="1"/>
  </joint>
</robot>
"""


def in_moving_frame(type_name: str, *values: dict[str, Any]) -> Callable[[Any], None]:
    """Messages in a tilted frame that is elsewhere at each of them."""

    def send(bench: DisplayBench) -> None:
        for number, each in enumerate(values):
            place = (float(number), 2.0 * number, 0.0)
            tilt = (0.5, 0.5, 0.5, 0.5)
            bench.transform("map", "sensor", place, tilt, stamp_ns=bench.now_ns)
            bench.send(type_name, each, frame="sensor")
            bench.turn(0.1)

    return send


def old_clouds(bench: DisplayBench) -> None:
    """Receive the points of `clouds` in the message type before PointCloud2."""
    bench.transform("map", "lidar", (1.0, 0.0, 0.5), (0.5, 0.5, 0.5, 0.5))
    points = [(1.0, 0.0, 0.1), (1.1, 0.2, 0.3), (40.0, 4.0, 4.4), (41.0, 4.1, 4.5)]
    channels = {"intensity": [100.0, 900.0, 30.0, 5000.0], "rgb": [1e-38, 2e-38, 3e-38, 4e-38]}
    channels |= {"r": [0.1, 0.2, 0.3, 0.4], "g": [0.5] * 4, "b": [0.6, 0.5, 0.4, 0.3]}
    values = {
        "points": np.array(points),
        "channels": [{"name": name, "values": each} for name, each in channels.items()],
    }
    for _ in range(2):
        bench.send("sensor_msgs/msg/PointCloud", values, frame="lidar")
        bench.turn()


def velocity(bench: DisplayBench) -> None:
    bench.transform("map", "base_link", (1.0, 0.0, 0.0))
    bench.transform("map", "robot", (1.0, 2.0, 0.0))
    bench.send("geometry_msgs/msg/Twist", MOTION)
    bench.turn()


def torques(bench: DisplayBench) -> None:
    """A weak and a strong torque of a joint, of which the frames are known with and without
    prefix."""
    urdf = ROBOT.replace("prismatic", "continuous").replace(
        "</joint>", '<axis xyz="1 2 3"/></joint>'
    )
    bench.send("std_msgs/msg/String", {"data": urdf}, topic="/robot_description")
    bench.turn()
    bench.settle()
    bench.transform("map", "robot/rider", (5.0, 0.0, 0.0))
    for number, effort in enumerate((0.25, 0.75)):
        place = (float(number), 0.0, 0.0)
        bench.transform("map", "rider", place, stamp_ns=bench.now_ns)
        values = {"name": ["slide"], "effort": [effort]}
        bench.send("sensor_msgs/msg/JointState", values, frame="", topic="/joint_states")
        bench.turn(0.1)


def at(x: float) -> dict[str, Any]:
    return {"position": {"x": x}, "orientation": {"w": 1.0}}


def turned(x: float) -> dict[str, Any]:
    """Return the pose of `at`, turned to the left."""
    return {"position": {"x": x}, "orientation": {"z": 0.6, "w": 0.8}}


COVARIANCE = np.diag([0.1, 0.2, 0.3, 0.1, 0.2, 0.3]).ravel()
MOTION = {"linear": {"x": 0.2, "y": 0.1}, "angular": {"z": 0.2}}
NAN = float("nan")


UNTURNED = {"w": 1.0}
POSE = {"position": {"x": 1.0}, "orientation": UNTURNED}
LINEAR_AND_ANGULAR = {"linear": {"x": 1.0}, "angular": {"z": 2.0}}

PLAIN_MESSAGES: dict[str, dict[str, Any]] = {
    "geometry_msgs/msg/PoseStamped": {"pose": POSE},
    "geometry_msgs/msg/PoseWithCovarianceStamped": {
        "pose": {"pose": POSE, "covariance": np.eye(6).ravel()}
    },
    "geometry_msgs/msg/PoseArray": {"poses": [POSE, {"orientation": UNTURNED}]},
    "nav2_msgs/msg/ParticleCloud": {
        "particles": [{"pose": POSE, "weight": weight} for weight in (0.25, 0.75)]
    },
    "geometry_msgs/msg/PointStamped": {"point": {"x": 1.0}},
    "geometry_msgs/msg/PolygonStamped": {"polygon": {"points": [{"x": 1.0}, {"y": 1.0}]}},
    "nav_msgs/msg/GridCells": {
        "cell_width": 0.5,
        "cell_height": 0.25,
        "cells": [{"x": 1.0}, {"x": 2.0}],
    },
    "geometry_msgs/msg/WrenchStamped": {"wrench": {"force": {"x": 1.0}, "torque": {"z": 2.0}}},
    "geometry_msgs/msg/TwistStamped": {"twist": LINEAR_AND_ANGULAR},
    "geometry_msgs/msg/AccelStamped": {"accel": LINEAR_AND_ANGULAR},
    "geometry_msgs/msg/Twist": LINEAR_AND_ANGULAR,
    "sensor_msgs/msg/JointState": {"name": ["slide", "elbow"], "effort": [1.0, 1.0]},
    "sensor_msgs/msg/Range": {
        "field_of_view": 0.5,
        "min_range": 0.1,
        "max_range": 4.0,
        "range": 2.0,
    },
    "sensor_msgs/msg/Temperature": {"temperature": 20.0, "variance": 0.25},
    "sensor_msgs/msg/FluidPressure": {"fluid_pressure": 1e5},
    "sensor_msgs/msg/PointCloud": {
        "points": [{"x": 1.0}, {"x": 2.0}],
        "channels": [{"name": "intensity", "values": [1.0, 2.0]}],
    },
}
"""A message of each type that draws something; `ROBOT` has the joint."""
