"""Several robots in one viewer: whose frames are meant by a name in a message."""

from __future__ import annotations

import functools
from collections.abc import Iterable, Sequence
from typing import Annotated

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz.api.declared import Color, Prop
from webviz.api.frames import FramePoses, Frames
from webviz.api.nodes import Pose
from webviz.data.transforms import Explanation, NewestTransform

_NAME = "[A-Za-z_][A-Za-z0-9_]*"
Namespace = Annotated[str, msgspec.Meta(max_length=256, pattern=f"^/?{_NAME}(/{_NAME})*$")]

KEY_PREFIX = r"^[A-Za-z0-9_-]+(/[A-Za-z0-9_-]+)*$"
"""Key expressions of Zenoh without wildcards and reserved characters."""


class NamespacedRobot(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A robot with topics of its own, also /tf, and with the frame names of the others."""

    namespace: Annotated[Namespace, Prop(help="Namespace of its topics, such as robot1.")]
    prefix: Annotated[
        str | None, Prop(help="Before the names of its frames; null is the namespace and a slash.")
    ] = None
    shared: Annotated[
        tuple[str, ...],
        msgspec.Meta(max_length=100),
        Prop(help="Frames that it shares with the others, which have no prefix."),
    ] = ("map",)
    connection: Annotated[
        Annotated[str, msgspec.Meta(max_length=1000, pattern="^(wss?://|(tcp|tls|quic)/)")] | None,
        Prop(
            help="Bridge of the robot, such as ws://robot1:8765, or Zenoh router, such as "
            "tcp/robot1:7447; null is the live topics."
        ),
    ] = None
    domain: Annotated[
        Annotated[int, msgspec.Meta(ge=0, le=232)] | None,
        Prop(help="ROS domain of the robot over Zenoh; null is ROS_DOMAIN_ID."),
    ] = None
    key_prefix: Annotated[
        Annotated[str, msgspec.Meta(max_length=200, pattern=KEY_PREFIX)] | None,
        Prop(
            help="Before all keys of the robot over Zenoh, such as fleet/robot1: the `namespace` "
            "of its sessions' configs; null for none."
        ),
    ] = None
    tint: Annotated[
        Color | None, Prop(help="Colour that is mixed into everything of it; null for none.")
    ] = None
    opacity: Annotated[
        float, msgspec.Meta(ge=0, le=1), Prop(help="Opacity of everything of it.")
    ] = 1.0

    @property
    def name(self) -> str:
        """The namespace without slashes around it."""
        return self.namespace.strip("/")

    @property
    def root(self) -> str:
        """Return the prefix of the full names of its topics."""
        return f"/{self.name}/"

    def frame(self, name: str) -> str:
        """Return the name in the viewer of a frame of the robot, which may be that already."""
        name = name.removeprefix("/")
        prefix = self._prefix
        return name if not name or name in self.shared or name.startswith(prefix) else prefix + name

    def own(self, frame: str) -> str:
        """Return the robot's own name of a frame of the viewer.

        Other robots' frames keep theirs.
        """
        return frame.removeprefix(self._prefix)

    @property
    def _prefix(self) -> str:
        return self.root[1:] if self.prefix is None else self.prefix


@functools.lru_cache(maxsize=8)
def robots_of(entries: tuple[str | NamespacedRobot, ...]) -> tuple[NamespacedRobot, ...]:
    """Return the entries of a config; a name alone is a namespace."""
    return tuple(NamespacedRobot(each) if isinstance(each, str) else each for each in entries)


def robot_of(topics: Iterable[str], robots: Sequence[NamespacedRobot]) -> NamespacedRobot | None:
    """Return the robot of a display, by the namespace of the first of its topics that has one."""
    for topic in topics:
        for robot in robots:
            if topic.startswith(robot.root):
                return robot
    return None


class RobotFrames(Frames):
    """The frames of a turn, by the names that one robot has for them.

    Args:
        frames: of the turn, which computes each pose once for all.
        robot: whose names are understood.
    """

    def __init__(self, frames: Frames, robot: NamespacedRobot) -> None:
        super().__init__(frames.buffer, frames.fixed_frame, frames.now_ns)
        self._frames = frames
        self._robot = robot

    def named(self, frame: str) -> str:
        """Return the name of a frame in the viewer."""
        return self._robot.frame(frame)

    def own(self, frame: str) -> str:
        """Return the robot's own name of a frame of the viewer."""
        return self._robot.own(frame)

    def at(self, frame: str, stamp_ns: int) -> Pose | None:
        """See `Frames.at`."""
        return self._frames.at(self.named(frame), stamp_ns)

    def link(self, frame: str) -> NewestTransform | None:
        """See `Frames.link`."""
        return self._frames.link(self.named(frame))

    def along(
        self, frame: str, stamps_ns: NDArray[np.int64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]]:
        """See `Frames.along`."""
        return self._frames.along(self.named(frame), stamps_ns)

    def explain(self, frame: str, stamp_ns: int = 0) -> Explanation:
        """See `Frames.explain`."""
        return self._frames.explain(self.named(frame), stamp_ns)

    def all(self) -> FramePoses:
        """See `Frames.all`."""
        return self._frames.all()
