"""The Effort display."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from typing import Annotated, NamedTuple

import msgspec
import numpy as np
from numpy.typing import NDArray

import webviz_urdf
from webviz import (
    Context,
    Details,
    Display,
    Frames,
    Group,
    Hit,
    Input,
    Keep,
    OtherFixedFrame,
    Pose,
    Prop,
    Remedy,
    Sample,
    Topic,
)
from webviz.data import messages
from webviz.data.rotations import matrices
from webviz.data.words import counted, listed
from webviz_displays.shared.colors import RAINBOW, Alpha, ramp
from webviz_displays.shared.geometry import Length, origin_near
from webviz_displays.shared.properties import HistoryLength, opaque, prefixed
from webviz_displays.shared.rods import add_solid_arrows, rods
from webviz_urdf import RobotDescriptionError, TurningJoint

F64 = NDArray[np.float64]

LEAST_SHARE, LEAST_RADIUS = 0.05, 0.05
"""A joint without effort has a small ring; its radius in metres."""

HEAD = 2.0
"""Length and radius of a head in widths of its ring."""

_ANGLES = np.arange(30) * (2 * np.pi / 32)
_CIRCLE = np.stack((np.sin(_ANGLES), np.cos(_ANGLES), np.zeros_like(_ANGLES)), axis=1)
"""Points from the head at y against the direction of the torque, open before the head."""


class Rings(NamedTuple):
    """N torques to draw.

    Attributes:
        names: (N,), of the joints.
        centers: (N, 3), metres.
        axes: (N, 3), unit vectors.
        efforts: (N,), Nm about the axes.
        largest: (N,), Nm, 0 where unknown.
    """

    names: NDArray[np.object_]
    centers: F64
    axes: F64
    efforts: F64
    largest: F64

    @classmethod
    def of(
        cls,
        names: Sequence[str],
        poses: Sequence[Pose],
        axes: Sequence[Sequence[float]],
        efforts: Sequence[float],
        largest: Sequence[float],
    ) -> Rings:
        """Rings of links at poses in the fixed frame, whose axes are given in those links."""
        turns = matrices(np.array([pose.wxyz for pose in poses]).reshape(-1, 4))
        own = np.array(axes, np.float64).reshape(-1, 3)
        return cls(
            np.array(names, object),
            np.array([pose.position for pose in poses], np.float64).reshape(-1, 3),
            np.einsum("nij,nj->ni", turns, own),
            np.array(efforts, np.float64),
            np.array(largest, np.float64),
        )


def shares(efforts: F64, largest: F64) -> F64:
    """Return the sizes of rings, from 0.05 for no effort to 1.05 for the largest, as in RViz.

    Without a largest effort it is the effort itself.
    """
    is_known = largest > 0
    share = np.abs(efforts) / np.where(is_known, largest, 1.0)
    return np.where(is_known, np.minimum(share, 1.0), share) + LEAST_SHARE


def add_rings(group: Group, rings: Rings, width: float, scale: float, alpha: float) -> None:
    """Draw rings from magenta (no effort) to red (the largest).

    Args:
        group: where to draw.
        rings: in its coordinates.
        width: of the rings, metres.
        scale: diameter of the ring of the largest effort, metres.
        alpha: opacity.
    """
    size = shares(rings.efforts, rings.largest)
    colors = ramp(size, 0.0, 1.0, RAINBOW[::-1])
    radii = LEAST_RADIUS + size * scale / 2
    turns = matrices(rods(np.zeros_like(rings.axes), rings.axes, 0.0).wxyzs)
    sides = turns * np.where(rings.efforts < 0, -1.0, 1.0)[:, None, None] * (1.0, 0.0, 0.0)
    frames = sides + turns * (0.0, 1.0, 1.0)  # negative torques are mirrored along x
    points = np.einsum("nij,pj->npi", frames, _CIRCLE) * radii[:, None, None]
    points += rings.centers[:, None]
    segments = np.stack((points[:, :-1], points[:, 1:]), axis=2)
    count = segments.shape[1]
    shades = np.repeat(colors, 2 * count, axis=0).reshape(-1, 2, 3)
    names = np.repeat(rings.names, count)
    group.lines("rings", segments.reshape(-1, 2, 3), shades, width, "m", names, alpha)
    starts = points[:, 0]
    heads = np.stack((starts, starts - HEAD * width * frames[:, :, 0]), axis=1)
    sizes = 0.0, HEAD * width, HEAD * width
    add_solid_arrows(group, heads, colors, *sizes, alpha, rings.names)


MAX_NM = 1e6
"""Larger efforts are not measurements; they could make a ring that cannot be drawn."""

NAMED = 20
"""Joints with a status of their own."""

MAX_NAMES = 1000
"""Joints that get a switch in the page."""

Joints = Mapping[str, TurningJoint]


class _Waiting(msgspec.Struct, frozen=True):
    """A message with the frames that it needs at its stamp."""

    number: int
    stamp_ns: int
    frames: tuple[str, ...]


class _State(msgspec.Struct):
    """State of what is drawn and what waits.

    Args:
        waiting: messages without a transform of some link at their stamp, oldest first.
        ready: number of the newest message that can be drawn.
        efforts: of the newest message that is drawn, Nm by joint.
        joints: of the robot.
    """

    waiting: list[_Waiting] = msgspec.field(default_factory=list)
    ready: int = -1
    efforts: dict[str, float] = msgspec.field(default_factory=dict)
    joints: Joints = msgspec.field(default_factory=dict)


class Effort(Display):
    """The torques of a robot's joints, as rings about their axes."""

    rviz = "rviz_default_plugins/Effort"

    topic: Annotated[
        Topic, Input("sensor_msgs/msg/JointState"), Prop(help="Topic of the joints' efforts.")
    ] = Topic("/joint_states")
    robot_description: Annotated[
        Topic,
        Input("std_msgs/msg/String", latched=True, is_plain=True, offered_for="robot_description"),
        Prop(help="Topic of the robot's URDF, which gives the axes and the largest efforts."),
    ] = Topic("/robot_description")
    alpha: Annotated[
        Alpha,
        Prop(help="Opacity of rings and heads."),
    ] = 1.0
    width: Annotated[Length, Prop(help="Width of the rings.")] = 0.02
    scale: Annotated[Length, Prop(help="Diameter of the ring of the largest effort.")] = 1.0
    tf_prefix: Annotated[
        str, Prop(rviz="TF Prefix", help="Prefix of the robot's frame names, as in prefix/link.")
    ] = ""
    history_length: HistoryLength = 1
    joints: Annotated[
        dict[str, bool],
        Prop(widget="names", help="Switches of single joints by name; others are shown."),
    ] = msgspec.field(default_factory=dict)

    def new_state(self) -> _State:
        """Nothing."""
        return _State()

    def history(self) -> Keep:
        """Return the newest messages, and those that wait for their transforms."""
        return Keep(count=self.history_length + self.topic.filter_size)

    def waits(self, name: str) -> bool:
        """Links have frames of their own; that of the header does not matter."""
        return False

    def depends(self, ctx: Context) -> object:
        """Return the newest message that can be drawn."""
        state: _State = ctx.state
        for each in reversed(state.waiting):
            if _is_ready(each, ctx.frames):
                state.ready = max(state.ready, each.number)
                break
        return state.ready

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Draw the rings of the newest messages, each link where it was at the stamp."""
        state: _State = ctx.state
        descriptions = [sample for sample in samples if sample.input == "robot_description"]
        measured = [sample for sample in samples if sample.input == "topic"]
        state.waiting, state.efforts = [], {}
        if not descriptions:
            topic = self.robot_description.name
            ctx.warn(
                "URDF", f"No robot description received on {topic}. Start robot_state_publisher."
            )
            return
        try:
            text = descriptions[-1].message.data
            joints = ctx.background(("joints", text), _turning_joints, text)
        except RobotDescriptionError as error:
            ctx.error("URDF", str(error))
            return
        if joints is None:
            ctx.warn("URDF", "Reading the robot description.")
            return
        state.joints = joints
        ctx.offered["joints"] = dict.fromkeys(itertools.islice(joints, MAX_NAMES), 1)
        ctx.ok("URDF", f"{counted(len(joints), 'joint')} that can turn.")
        self._draw_rings(measured, joints, ctx)

    def inspect(self, hit: Hit, ctx: Context) -> Details | None:
        """Return the newest effort of a joint."""
        state: _State = ctx.state
        name = str(hit.id)
        if name not in state.efforts:
            return None
        joint = state.joints[name]
        return Details(
            f"Joint {name}",
            {
                "Effort": f"{state.efforts[name]:.6g} Nm",
                "Largest effort": f"{joint.max_effort:g} Nm" if joint.max_effort else "not given",
                "Link": joint.child,
            },
        )

    def _draw_rings(self, measured: Sequence[Sample], joints: Joints, ctx: Context) -> None:
        state: _State = ctx.state
        rings: list[Rings] = []
        newest: Sample | None = None
        for sample in reversed(measured):
            efforts = self._efforts(sample.message, joints)
            frames = tuple(prefixed(self.tf_prefix, joints[name].child) for name in efforts)
            waiting = _Waiting(sample.number, sample.stamp_ns, frames)
            if newest is None and not _is_ready(waiting, ctx.frames):
                state.waiting.insert(0, waiting)
                continue
            if newest is None:
                newest, state.efforts = sample, efforts
                state.ready = max(state.ready, sample.number)
            rings.append(self._rings(efforts, frames, sample.stamp_ns, joints, ctx.frames))
            if len(rings) == self.history_length:
                break
        if measured and newest is None:
            waiting = state.waiting[-1]
            unplaced = next(f for f in waiting.frames if ctx.frames.at(f, waiting.stamp_ns) is None)
            reason = ctx.frames.explain(unplaced, waiting.stamp_ns)
            ctx.error("Transform", reason.sentence, OtherFixedFrame.of(reason), reason)
        if newest is None:
            return
        self._report(newest.message, state.efforts, joints, rings[0], ctx)
        whole = Rings(*(np.concatenate(parts) for parts in zip(*rings, strict=True)))
        if self.alpha == 0:
            ctx.warn("Efforts", "Invisible: alpha is 0. Increase it to show the rings.", opaque())
        elif len(whole.names):
            origin = origin_near(whole.centers)
            group = ctx.follow(None, offset=Pose(origin))
            moved = whole._replace(centers=whole.centers - origin)
            add_rings(group, moved, self.width, self.scale, self.alpha)

    def _rings(
        self,
        efforts: Mapping[str, float],
        frames: Sequence[str],
        stamp_ns: int,
        joints: Joints,
        transforms: Frames,
    ) -> Rings:
        """Return the rings of one message; joints without a transform have none."""
        poses = [
            (name, transforms.at(frame, stamp_ns))
            for name, frame in zip(efforts, frames, strict=True)
        ]
        placed = [(name, pose) for name, pose in poses if pose is not None]
        return Rings.of(
            [name for name, _ in placed],
            [pose for _, pose in placed],
            [joints[name].axis for name, _ in placed],
            [efforts[name] for name, _ in placed],
            [joints[name].max_effort for name, _ in placed],
        )

    def _report(
        self,
        message: messages.JointState,
        efforts: Mapping[str, float],
        joints: Joints,
        rings: Rings,
        ctx: Context,
    ) -> None:
        """Say what the newest message has, and what of it is not drawn."""
        if len(message.effort) != len(message.name):
            ctx.error(
                "Efforts",
                f"The message has {len(message.effort)} efforts for {len(message.name)} joints. "
                "Fix the publisher.",
            )
            return
        turning = [name for name in message.name if name in joints]
        invalid = [name for name in turning if self._shows(name) and name not in efforts]
        unplaced = [name for name in efforts if name not in rings.names]
        hidden = sum(not self._shows(name) for name in turning)
        off = f"; {hidden} switched off" if hidden else ""
        ctx.ok("Efforts", f"Showing {counted(len(rings.names), 'joint')}{off}.")
        if invalid:
            names = listed(invalid, NAMED)
            ctx.warn("Efforts", f"Efforts are not finite or above 1e6 Nm: {names}.")
        elif unplaced:
            ctx.warn("Efforts", f"Links have no transform: {listed(unplaced, NAMED)}.")
        elif not turning:
            ctx.warn(
                "Efforts",
                "No joint of the message turns in the robot description. Check their names.",
            )
        elif hidden == len(turning):
            text = "All joints are switched off. Switch some of them on."
            ctx.warn("Efforts", text, Remedy("joints", {}, "Show all joints"))
        for name in list(efforts)[:NAMED]:
            most = joints[name].max_effort
            limit = f" of {most:g} Nm" if most else ", without a largest effort in the URDF"
            ctx.ok(f"Joint {name}", f"{efforts[name]:.4g} Nm{limit}")

    def _shows(self, joint: str) -> bool:
        return self.joints.get(joint, True)

    def _efforts(self, message: messages.JointState, joints: Joints) -> dict[str, float]:
        """Return the sensible efforts in Nm of the joints that turn and are shown, by name."""
        if len(message.effort) != len(message.name):
            return {}
        pairs = zip(message.name, message.effort.tolist(), strict=True)
        return {
            name: effort
            for name, effort in pairs
            if name in joints and self._shows(name) and abs(effort) < MAX_NM
        }


def _turning_joints(text: str) -> Joints:
    return webviz_urdf.turning_joints(text)  # imports what reads XML, in the worker


def _is_ready(message: _Waiting, frames: Frames) -> bool:
    """Return whether all links have a pose at the stamp, but for those that have none at all."""
    return all(
        frames.at(frame, message.stamp_ns) is not None or frames.latest(frame) is None
        for frame in message.frames
    )
