"""A message of each type that the displays read; see `DisplayChecks.messages`."""

from __future__ import annotations

from typing import Any

import numpy as np
import photos
from autoware_scenes import AUTOWARE_MESSAGES
from clouds import CLOUD, xyz_cloud
from mapping_scenes import MAPPING_MESSAGES
from moveit_scenes import MOVEIT_MESSAGES
from perception_scenes import PERCEPTION_MESSAGES
from plain_scenes import PLAIN_MESSAGES
from rtabmap_scenes import RTABMAP_MESSAGES

Values = dict[str, Any]

UNTURNED = {"w": 1.0}
GRID = {
    "info": {"width": 3, "height": 2, "resolution": 0.5, "origin": {"orientation": UNTURNED}},
    "data": [0, 30, 60, 98, 100, -1],
}
MESSAGES: dict[str, Values] = {
    "sensor_msgs/msg/LaserScan": {
        "angle_min": -1.0,
        "angle_max": 1.0,
        "angle_increment": 0.5,
        "time_increment": 0.001,
        "scan_time": 0.1,
        "range_min": 0.1,
        "range_max": 30.0,
        "ranges": [1.0, 2.0, 3.0, 4.0, 5.0],
        "intensities": [10.0, 20.0, 30.0, 40.0, 50.0],
    },
    "nav_msgs/msg/OccupancyGrid": GRID,
    "map_msgs/msg/OccupancyGridUpdate": {"x": 1, "y": 0, "width": 1, "height": 1, "data": [77]},
    "nav_msgs/msg/Odometry": {
        "pose": {"pose": {"orientation": UNTURNED}, "covariance": np.eye(6).ravel()},
        "child_frame_id": "base_link",
    },
    "nav_msgs/msg/Path": {
        "poses": [{"pose": {"position": {"x": x}, "orientation": UNTURNED}} for x in (0.0, 1.0)]
    },
    photos.RAW: photos.raw(photos.room(16, 12)[1], "32FC1"),
    CLOUD: xyz_cloud([(1, 0, 0), (2, 0, 1), (3, 1, 2)], {"intensity": [1, 2, 3]}),
    "std_msgs/msg/String": {
        "data": "<robot name='r'><link name='sensor'><visual><geometry><sphere radius='1'/>"
        "</geometry></visual></link><link name='arm'/><joint name='elbow' type='continuous'>"
        "<parent link='arm'/><child link='sensor'/></joint></robot>"
    },
    **PLAIN_MESSAGES,
    **MAPPING_MESSAGES,
    **PERCEPTION_MESSAGES,
    **AUTOWARE_MESSAGES,
    **RTABMAP_MESSAGES,
    **MOVEIT_MESSAGES,
}
"""A message of each type that draws something."""
