"""Vehicle declared by a tool that drives a robot."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

from webviz.api.declared import Topic


class Velocity(NamedTuple):
    """A velocity in the robot's own frame: x ahead, y to the left, counter-clockwise about z.

    Args:
        linear, lateral: in m/s.
        angular: in rad/s.
    """

    linear: float = 0.0
    lateral: float = 0.0
    angular: float = 0.0


STILL = Velocity()


@dataclass(frozen=True)
class Vehicle:
    """A robot that takes velocity commands.

    Args:
        topic: of the commands.
        type: of their messages, such as "geometry_msgs/msg/Twist".
        limits: the highest speed along each axis; 0 turns an axis off.
        acceleration, deceleration: the fastest change of each speed, away from zero and towards
            it, in m/s² and rad/s².
        message: the values of a command by field, from a velocity and ROS time in ns. Called from
            another thread.
        odometry: where the robot reports its velocity, as nav_msgs/msg/Odometry.
    """

    topic: Topic
    type: str
    limits: Velocity
    acceleration: Velocity
    deceleration: Velocity
    message: Callable[[Velocity, int], Mapping[str, Any]]
    odometry: Topic
