"""A robot as its description says, where its transforms say."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Annotated, Literal

import msgspec

from webviz import Context, Display, Input, Node, Prop, Sample, Topic
from webviz_displays.robot_loading import Description, Loading, describe_file
from webviz_displays.robot_parts import Choices, LinkSettings, Paint, Part, parts_of
from webviz_urdf import Missing, Robot, RobotDescriptionError

SECOND = 1_000_000_000
NAMED = 3
"""Missing meshes, warnings and lost links that a status names; the rest is counted."""


class MassProperties(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What to show of the links' inertial properties."""

    mass: Annotated[bool, Prop(help="A ball of lead of each link's mass.")] = False
    inertia: Annotated[bool, Prop(help="The box that has each link's moments of inertia.")] = False


@dataclass(eq=False)
class _Model:
    """A loaded robot as it is drawn.

    Args:
        frames: frame id of each link that is drawn or would be.
        parts: what is drawn.
        paint: of the parts.
        seen: frames that ever had a transform; a link without has no place to be drawn at.
        lost: links without a transform when `drawn` was chosen.
        drawn: the parts with a place, and their nodes, grey where the link is lost.
        reason: why a link is lost, behind what and when that was asked for.
    """

    frames: dict[str, str]
    parts: list[Part]
    paint: Paint
    seen: set[str]
    lost: list[str] | None = None
    drawn: list[tuple[Part, Node]] = field(default_factory=list)
    reason: tuple[object, str] = (None, "")


class RobotModel(Display):
    """A robot's links, placed by the transforms between their frames."""

    rviz = "rviz_default_plugins/RobotModel"

    description_topic: Annotated[
        Topic,
        Input("std_msgs/msg/String", latched=True, optional=True),
        Prop(when=("description_source", "Topic"), help="Where the robot's URDF is published."),
    ] = Topic("/robot_description")
    description_source: Annotated[
        Literal["Topic", "File"], Prop(help="Whether the robot's URDF comes by topic or by file.")
    ] = "Topic"
    description_file: Annotated[
        str,
        Prop(
            when=("description_source", "File"),
            help="A URDF file, or a xacro file, on the machine webviz runs on.",
        ),
    ] = ""
    package_paths: Annotated[
        list[str],
        Prop(help="Folders with ROS packages; searched for meshes before AMENT_PREFIX_PATH."),
    ] = msgspec.field(default_factory=list)
    visual_enabled: Annotated[bool, Prop(help="Draw the links' visual shapes.")] = True
    collision_enabled: Annotated[bool, Prop(help="Draw the links' collision shapes.")] = False
    mass_properties: Annotated[MassProperties, Prop(help="Draw masses and inertias.")] = (
        MassProperties()
    )
    alpha: Annotated[float, Prop(ge=0, le=1, widget="slider", help="Opacity of the links.")] = 1.0
    tf_prefix: Annotated[
        str,
        Prop(rviz="TF Prefix", help="The robot's frames are named prefix/link, as in a namespace."),
    ] = ""
    all_links_enabled: Annotated[
        bool,
        Prop(rviz="Links/All Links Enabled", help="Draw the links without settings of their own."),
    ] = True
    links: Annotated[dict[str, LinkSettings], Prop(help="Settings of single links, by name.")] = (
        msgspec.field(default_factory=dict)
    )

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Properties or the description changed: `tick` loads and chooses anew."""
        ctx.state["text"] = samples[-1].message.data if samples else None
        ctx.state["said"] = None

    def tick(self, ctx: Context) -> None:
        """Place the parts; those of links without a transform turn grey and stay."""
        if ctx.state["said"] is None or ctx.state["loading"]:
            self._choose(ctx)
            ctx.state["said"] = dict(ctx.statuses)
        ctx.statuses.update(ctx.state["said"])
        model: _Model | None = ctx.state.get("model")
        if model is None:
            return
        latest = ctx.frames.latest
        lost = [link for link, frame in model.frames.items() if latest(frame) is None]
        if lost != model.lost:
            gone = set(lost)
            model.lost = lost
            model.seen.update(frame for link, frame in model.frames.items() if link not in gone)
            model.drawn = [
                (part, model.paint(part.node, grey=True) if part.link in gone else part.node)
                for part in model.parts
                if model.frames[part.link] in model.seen
            ]
        for part, node in model.drawn:
            frame = model.frames[part.link]
            ctx.follow(frame, keep_last=True).add(part.key, node, part.pose)
        _report_lost(model, lost, ctx)

    def _choose(self, ctx: Context) -> None:
        """Load what is new, and choose what to draw of it."""
        before, ctx.state["loading"] = ctx.state.get("loading", {}), {}
        description = self._description(ctx)
        if description is None:
            ctx.state.pop("model", None)
            return
        try:
            robot = _load(description, False, before, ctx)
            full = _load(description, True, before, ctx) if self.collision_enabled else None
        except RobotDescriptionError as error:
            ctx.state.pop("model", None)
            ctx.error("URDF", str(error))
            return
        if robot is None:
            return  # until the new robot is there, the old one stays
        _report(robot, full, ctx)
        if not (self.visual_enabled or self.collision_enabled):
            ctx.warn("Shapes", "Neither visual nor collision shapes are switched on.")
        choices = Choices(
            self.visual_enabled,
            self.collision_enabled,
            self.mass_properties.mass,
            self.mass_properties.inertia,
            self.alpha,
            self.links,
            self.all_links_enabled,
        )
        paint: Paint = ctx.state.setdefault("paint", Paint())
        paint.begin()
        prefix = f"{self.tf_prefix.strip('/')}/" if self.tf_prefix.strip("/") else ""
        frames = {link: f"{prefix}{link}" for link in robot.links if choices.of(link).enabled}
        parts = parts_of(robot, full, choices, paint)
        ctx.state["model"] = _Model(frames, parts, paint, ctx.state.setdefault("seen", set()))

    def _description(self, ctx: Context) -> Description | None:
        paths = tuple(self.package_paths)
        if self.description_source == "File":
            if self.description_file:
                return describe_file(self.description_file, paths)
            ctx.warn("URDF", "No description file is chosen.")
            return None
        if ctx.state["text"] is not None:
            return Description(text=ctx.state["text"], package_paths=paths)
        ctx.warn("URDF", f"No robot description yet on {self.description_topic.name}.")
        return None


def _load(
    description: Description, collisions: bool, before: dict[object, Loading], ctx: Context
) -> Robot | None:
    """The robot, None while it is being loaded; `before` is what was being loaded so far."""
    key = (description, collisions)
    loading = before.get(key) or Loading()
    robot = ctx.background(key, description.load, collisions, loading)
    if robot is None:
        ctx.state["loading"][key] = loading
        ctx.warn("Loading", loading.text)
    return robot


def _report(robot: Robot, full: Robot | None, ctx: Context) -> None:
    """Say what was read and what is missing."""
    missing = [m for m in (full or robot).missing if full or m.kind == "visual"]
    drawn = sum(len(link.visuals) for link in robot.links.values())
    total = drawn + sum(m.kind == "visual" for m in missing)
    text = f"'{robot.name}': {_count(len(robot.links), 'link')}, {drawn} of {total} visuals loaded."
    (ctx.ok if total else ctx.warn)("URDF", text)
    if missing:
        ctx.error("Meshes", f"{_count(len(missing), 'shape')} missing. " + _listed(missing))
    if robot.warnings:
        rest = len(robot.warnings) - NAMED
        more = (f"And {rest} more.",) if rest > 0 else ()
        ctx.warn("URDF warnings", " ".join((*robot.warnings[:NAMED], *more)))


def _report_lost(model: _Model, lost: list[str], ctx: Context) -> None:
    if not lost:
        ctx.ok("Links", f"{_count(len(model.frames), 'link')} placed by transforms.")
        return
    # The explanation holds times, so it is renewed, but not on every tick.
    moment = (tuple(lost), ctx.frames.now_ns // SECOND)
    if model.reason[0] != moment:
        model.reason = (moment, ctx.frames.why_not(model.frames[lost[0]]))
    names = ", ".join(lost[:NAMED]) + (
        f" and {len(lost) - NAMED} more" if len(lost) > NAMED else ""
    )
    ctx.error(
        "Links",
        f"{len(lost)} of {_count(len(model.frames), 'link')} without a transform: {names}. "
        f"{model.reason[1]} What was seen before is grey where it was.",
    )


def _listed(missing: Sequence[Missing]) -> str:
    first = " ".join(f"Link '{m.link}': {m.reason}" for m in missing[:NAMED])
    rest = len(missing) - NAMED
    return f"{first} And {rest} more." if rest > 0 else first


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
