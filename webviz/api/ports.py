"""Annotations that make a `Topic` property an input of a display or an output of a tool."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Input:
    """Marks a `Topic` property as an input of the display or tool.

    Args:
        type: the message type, such as "sensor_msgs/msg/LaserScan". Messages with a header wait
            for the transform at their stamp.
        latched: subscribe transient local, whatever the known publishers offer.
        suffix: without a topic name, the input uses the first input's topic with this suffix.
        optional: having no publisher is not a problem.
        every: take latched messages even if they equal the one before, as they may say it anew.
    """

    type: str
    latched: bool = False
    suffix: str = ""
    optional: bool = False
    every: bool = False


@dataclass(frozen=True)
class Output:
    """Marks a `Topic` property as an output of a tool.

    If the topic says `auto`, it is published as RViz does: reliable, volatile, depth 5.

    Args:
        type: the message type, such as "geometry_msgs/msg/PoseStamped".
    """

    type: str
