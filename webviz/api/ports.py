"""Annotations that make a `Topic` property an input of a display or an output of a tool."""

from __future__ import annotations

from dataclasses import dataclass

TRANSPORTS = ("compressed", "compressedDepth", "theora", "ffmpeg", "foxglove", "zstd")
"""Ends of the topics of image_transport."""

ANY = "*"
"""The message type of an input that reads messages of every type."""


@dataclass(frozen=True)
class Input:
    """Marks a `Topic` property as an input of the display or tool.

    Args:
        type: the message type, such as "sensor_msgs/msg/LaserScan", or `ANY`. Messages with a
            header wait for the transform at their stamp.
        latched: subscribe transient local, whatever the known publishers offer.
        suffix: without a topic name, the input uses the first input's topic with this suffix.
        beside: without a topic name, the input uses the topic of this name beside the first input's
            topic, whatever transport that is: camera_info beside image_raw/compressed.
        optional: having no publisher is not a problem.
        unless: another input; once that has messages, having no publisher is not a problem.
        every: take latched messages even if they equal the one before, as they may say it anew.
        also: further message types that the display reads; the publishers of the topic decide, and
            `Sample.type` names the type.
        is_plain: .rviz files have the name only, without QoS.
        is_offered: whether the display can be added for a topic of this type.
        offered_for: ending of the names of the topics that it can be added for, such as
            "robot_description"; "" for all.
        is_sporadic: whether messages come when something happens, such as a new plan: silence after
            several is no problem.
    """

    type: str
    latched: bool = False
    suffix: str = ""
    beside: str = ""
    optional: bool = False
    unless: str = ""
    every: bool = False
    also: tuple[str, ...] = ()
    is_plain: bool = False
    is_offered: bool = True
    offered_for: str = ""
    is_sporadic: bool = False

    @property
    def follows(self) -> bool:
        """Return whether its topic follows from that of the first input."""
        return bool(self.suffix or self.beside)

    def named_after(self, first: str) -> str:
        """Its topic without a name of its own, "" if it has none then.

        Args:
            first: full name of the first input's topic.
        """
        if not first or not self.beside:
            return first + self.suffix if first and self.suffix else ""
        folder, _, last = first.rpartition("/")
        if last in TRANSPORTS:
            folder = folder.rpartition("/")[0]
        return f"{folder}/{self.beside}"

    @property
    def types(self) -> tuple[str, ...]:
        """All message types, the preferred one first."""
        return (self.type, *self.also)


@dataclass(frozen=True)
class Namespace:
    """A text property that names a namespace, and the topic there by which one is known.

    Args:
        input: the property.
        type: the message type of the topic.
        ending: of its name, such as "/update".
    """

    input: str
    type: str
    ending: str


@dataclass(frozen=True)
class Output:
    """Marks a `Topic` property as an output of a tool.

    If the topic says `auto`, it is published as RViz does: reliable, volatile, depth 5.

    Args:
        type: the message type, such as "geometry_msgs/msg/PoseStamped".
    """

    type: str
