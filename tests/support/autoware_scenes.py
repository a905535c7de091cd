"""Messages of Autoware's planning, perception and localization."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from plain_scenes import in_moving_frame

Values = dict[str, Any]

PATH, TRAJECTORY = "autoware_planning_msgs/msg/Path", "autoware_planning_msgs/msg/Trajectory"
POSE = "geometry_msgs/msg/PoseStamped"


def pose_at(x: float, y: float, z: float = 0.0, yaw: float = 0.0) -> Values:
    """A pose that looks along the ground."""
    turn = {"z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}
    return {"position": {"x": x, "y": y, "z": z}, "orientation": turn}


def planned(*points: tuple[float, float, float], speeds: tuple[float, ...] = ()) -> list[Values]:
    """Points of a path along x, which is faster from point to point, half a second apart."""
    fast = speeds or tuple(float(number) for number in range(len(points)))
    return [
        {
            "pose": pose_at(*point),
            "longitudinal_velocity_mps": speed,
            "lateral_velocity_mps": 0.25,
            "heading_rate_rps": 0.125,
        }
        for point, speed in zip(points, fast, strict=True)
    ]


WAY = planned((0.0, 0.0, 0.0), (1.0, 0.0, 0.1), (2.0, 0.0, 0.3), (4.0, 0.0, 0.3))
BOUNDED = {
    "points": WAY,
    "left_bound": [{"x": 0.0, "y": 3.0}, {"x": 4.0, "y": 3.0}],
    "right_bound": [{"x": 0.0, "y": -3.0}, {"x": 4.0, "y": -3.0}],
}
"""A path between two bounds."""
TIMED = {
    "points": [
        {**point, "time_from_start": {"nanosec": 250_000_000 * number}, "acceleration_mps2": 0.5}
        for number, point in enumerate(WAY)
    ]
}
"""A trajectory along the same points."""
PASSED = [{"pose": pose_at(x, y)} for x, y in ((0.0, 0.0), (1.0, 0.5), (2.0, 0.0))]

AUTOWARE_SCENES: dict[str, Callable[[Any], None]] = {
    "AutowarePath": in_moving_frame(PATH, BOUNDED),
    "AutowareTrajectory": in_moving_frame(TRAJECTORY, TIMED),
    "PoseHistory": in_moving_frame(POSE, *PASSED * 110),  # more than its default shows
}

AUTOWARE_MESSAGES: dict[str, Values] = {PATH: BOUNDED, TRAJECTORY: TIMED}
"""A message of each type that draws something."""
