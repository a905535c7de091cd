"""The RobotModel display."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Annotated, Literal

import msgspec

from webviz import (
    Context,
    Details,
    Display,
    Frames,
    Hit,
    Input,
    Lookback,
    Prop,
    Remedy,
    Sample,
    Topic,
)
from webviz.data.transforms import Explanation
from webviz_displays.robot_model.details import TRAIL, link_details
from webviz_displays.robot_model.joint_states import ReceivedRobot
from webviz_displays.robot_model.loading import Loadings, Written, last_written, load, progress
from webviz_displays.robot_model.parts import (
    GREY,
    Choices,
    JointSettings,
    LinkSettings,
    Paint,
    parts_of,
)
from webviz_displays.robot_model.placing import ByJoints, ByTransforms, JointPlacer, Placing
from webviz_displays.robot_model.statuses import (
    NAMED,
    report_joint,
    report_joints,
    report_link,
    report_places,
    report_robot,
    report_unknown,
)
from webviz_displays.shared.colors import Alpha
from webviz_displays.shared.properties import prefixed
from webviz_displays.shared.trails import Trails
from webviz_urdf import LoadRequest, Robot, RobotDescriptionError

__all__ = ["RobotModel"]


class LoadedRobot(msgspec.Struct, frozen=True, eq=False):
    """A loaded robot.

    Args:
        robot: without collision shapes.
        full: with them; None if they are switched off or still loading.
        placing: where its links are.
        visible_links: links that are switched on.
    """

    robot: Robot
    full: Robot | None
    placing: Placing
    visible_links: tuple[str, ...]

    def unplaced(self, frames: Frames) -> list[str]:
        """Return enabled links without a pose."""
        pose = self.placing.pose
        return [link for link in self.visible_links if pose(link, frames) is None]


class RobotDrawing(msgspec.Struct):
    """The robot that is shown, and what follows from it.

    Args:
        loading: what is being loaded.
        written: when the description file was.
        model: the robot, None until one is loaded.
        grey: links that were drawn without a transform, None before anything was drawn.
        paint: the colours of parts.
        reasons: why links are lost.
        reasons_of: which links, and at which second that was asked.
        trails: of links, in `trails_frame`.
        trails_frame: fixed frame.
        owners: the link of each part that was drawn, by its key.
        placer: places the robot by its joints.
    """

    loading: Loadings = msgspec.field(default_factory=dict)
    written: Written = msgspec.field(default_factory=Written)
    model: LoadedRobot | None = None
    grey: set[str] | None = None
    paint: Paint = msgspec.field(default_factory=Paint)
    reasons: dict[str, Explanation] = msgspec.field(default_factory=dict)
    reasons_of: tuple[list[str], int] | None = None
    trails: Trails = msgspec.field(default_factory=Trails)
    trails_frame: str = ""
    owners: dict[str, str] = msgspec.field(default_factory=dict)
    placer: JointPlacer | None = None


SECOND = 1_000_000_000


class MassProperties(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Inertial properties of the links to show."""

    mass: Annotated[bool, Prop(help="Show each link's mass as a lead sphere.")] = False
    inertia: Annotated[
        bool, Prop(help="Show each link's inertia as a box with the same moments.")
    ] = False


class RobotModel(Display):
    """A robot's links, placed by the transforms between their frames."""

    rviz = "rviz_default_plugins/RobotModel"
    icon = "robot"

    description_topic: Annotated[
        Topic,
        Input("std_msgs/msg/String", latched=True, optional=True, offered_for="robot_description"),
        Prop(when=("description_source", "Topic"), help="Topic of the robot's URDF."),
    ] = Topic("/robot_description")
    description_source: Annotated[
        Literal["Topic", "File"], Prop(help="Read the robot's URDF from a topic or from a file.")
    ] = "Topic"
    description_file: Annotated[
        str,
        Prop(
            when=("description_source", "File"),
            help="URDF file on the machine that runs webviz; xacro files need WEBVIZ_XACRO=1.",
        ),
    ] = ""
    package_paths: Annotated[
        list[str],
        Prop(
            help="Folders with ROS packages to search for meshes before those on "
            "AMENT_PREFIX_PATH. Files outside packages need --mesh-root."
        ),
    ] = msgspec.field(default_factory=list)
    joint_source: Annotated[
        Literal["Transforms", "Joint states"],
        Prop(
            help="Place links by the transforms of robot_state_publisher, or compute their poses "
            "from joint states, which needs only the transform of the root link."
        ),
    ] = "Transforms"
    joint_states_topic: Annotated[
        Topic,
        Input("sensor_msgs/msg/JointState", optional=True),
        Prop(when=("joint_source", "Joint states"), help="Topic of the positions of the joints."),
    ] = Topic("/joint_states")
    visual_enabled: Annotated[bool, Prop(help="Draw the links' visual shapes.")] = True
    collision_enabled: Annotated[bool, Prop(help="Draw the links' collision shapes.")] = False
    mass_properties: Annotated[
        MassProperties, Prop(help="Draw the links' masses and inertias.")
    ] = MassProperties()
    update_interval: Annotated[
        float,
        Prop(ge=0, unit="s", help="Minimum time between moves; 0 moves as often as possible."),
    ] = 0.0
    alpha: Annotated[Alpha, Prop(help="Opacity of the links.")] = 1.0
    tf_prefix: Annotated[
        str, Prop(rviz="TF Prefix", help="Prefix of the robot's frame names, as in prefix/link.")
    ] = ""
    all_links_enabled: Annotated[
        bool,
        Prop(
            rviz="Links/All Links Enabled",
            help="Draw the links that have no settings of their own.",
        ),
    ] = True
    links: Annotated[dict[str, LinkSettings], Prop(help="Settings of single links by name.")] = (
        msgspec.field(default_factory=dict)
    )
    joints: Annotated[dict[str, JointSettings], Prop(help="Settings of single joints by name.")] = (
        msgspec.field(default_factory=dict)
    )

    def new_state(self) -> RobotDrawing:
        """No robot."""
        return RobotDrawing()

    def listens(self, name: str) -> bool:
        """Return whether an input is needed: no topic for files, no joint states for transforms."""
        if name == "joint_states_topic":
            return self.joint_source == "Joint states"
        return self.description_source == "Topic"

    def waits(self, name: str) -> bool:
        """Positions of joints need no transform."""
        return False

    def lookback(self, name: str) -> Lookback:
        """Return the newest description; all joint states, as each may have some of the joints."""
        return Lookback(count=int(name != "joint_states_topic"))

    def fold(self, name: str, sample: Sample, state: ReceivedRobot | None) -> ReceivedRobot:
        """Remember the description, and of each joint its newest position."""
        return (state or ReceivedRobot()).with_sample(name, sample)

    def depends(self, ctx: Context) -> object:
        """Return loading progress, and which links lack a transform; those turn grey.

        Links lost when it was drawn count too: a robot just loaded has no earlier state.
        """
        state: RobotDrawing = ctx.state
        loading = [progress(loading) for loading in state.loading.values()]
        unplaced = state.model.unplaced(ctx.frames) if state.model else []
        return loading, unplaced, state.grey, self._round(ctx)

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Draw the current robot; each link moves with its frame."""
        state: RobotDrawing = ctx.state
        model = state.model = self._model(samples, ctx)
        if model is None:
            return
        report_robot(model.robot, model.full, ctx)
        if isinstance(model.placing, ByJoints):
            placing = model.placing
            report_joints(placing.missing, placing.total, placing.fault, ctx)
        if not (self.visual_enabled or self.collision_enabled):
            ctx.warn(
                "Shapes",
                "Neither visual nor collision shapes are switched on. Enable one of them.",
                Remedy("visual_enabled", True, "Show visual shapes"),
            )
        report_unknown("Link", list(self.links), list(model.robot.links), ctx)
        report_unknown("Joint", list(self.joints), list(model.robot.joints), ctx)
        for name in [joint for joint in self.joints if joint in model.robot.joints][:NAMED]:
            report_joint(model.robot.joints[name], ctx)
        paint = state.paint
        paint.begin()
        state.owners.clear()
        unplaced = state.grey = set(model.unplaced(ctx.frames))
        for part in parts_of(model.robot, model.full, self._choices(), paint):
            group = model.placing.group(part.link, ctx, self.update_interval)
            color = GREY if part.link in unplaced else None
            group.add(part.key, paint(part.node, color=color), part.pose)
            state.owners[part.key] = part.link

    def tick(self, ctx: Context) -> None:
        """Report where links are, and draw their trails."""
        model: LoadedRobot | None = ctx.state.model
        if model is None:
            return
        unplaced = model.unplaced(ctx.frames)
        placing = model.placing
        reasons = self._reasons(model, unplaced, ctx)
        report_places(
            len(model.visible_links), unplaced, reasons, placing.source, placing.lacks, ctx
        )
        chosen = {link: self.links[link] for link in model.visible_links if link in self.links}
        for link in [link for link, chosen in chosen.items() if chosen.show_axes][:NAMED]:
            if pose := model.placing.pose(link, ctx.frames):
                report_link(link, pose, ctx)
        self._draw_trails(model, [link for link, c in chosen.items() if c.show_trail], ctx)

    def inspect(self, hit: Hit, ctx: Context) -> Details | None:
        """Return a link, by one of its shapes, its trail or a joint on it."""
        model: LoadedRobot | None = ctx.state.model
        if model is None:
            return None
        link = ctx.state.owners.get(hit.key) or hit.key.removesuffix(TRAIL)
        if link not in model.robot.links:
            return None
        pose, frame = model.placing.pose(link, ctx.frames), model.placing.frame(link)
        return link_details(model.full or model.robot, link, pose, frame, ctx.frames)

    def _reasons(
        self, model: LoadedRobot, links: list[str], ctx: Context
    ) -> dict[str, Explanation]:
        """Return why the first links are lost; texts contain times, so they change every second."""
        state: RobotDrawing = ctx.state
        moment = (links, ctx.frames.now_ns // SECOND)
        if state.reasons_of != moment:
            state.reasons_of = moment
            state.reasons = model.placing.reasons(model.robot, links, ctx.frames)
        return state.reasons

    def _draw_trails(self, model: LoadedRobot, links: list[str], ctx: Context) -> None:
        state: RobotDrawing = ctx.state
        if state.trails_frame != ctx.frames.fixed_frame:
            state.trails, state.trails_frame = Trails(), ctx.frames.fixed_frame
        poses = {link: model.placing.pose(link, ctx.frames) for link in links}
        state.trails.update({link: pose and pose.position for link, pose in poses.items()})
        state.trails.draw(ctx)

    def _choices(self) -> Choices:
        return Choices(
            self.visual_enabled,
            self.collision_enabled,
            self.mass_properties.mass,
            self.mass_properties.inertia,
            self.alpha,
            self.links,
            self.joints,
            self.all_links_enabled,
        )

    def _model(self, samples: Sequence[Sample], ctx: Context) -> LoadedRobot | None:
        """Return the described robot; the previous one until it is loaded."""
        state: RobotDrawing = ctx.state
        before, state.loading = state.loading, {}
        request = self._request(samples, ctx)
        if request is None:
            return state.model if "Loading" in ctx.statuses else None
        try:
            robot = load(request, before, ctx, state.loading)
            full = None
            if self.collision_enabled:
                collisions = replace(request, collisions=True)
                full = load(collisions, before, ctx, state.loading)
        except RobotDescriptionError as error:
            ctx.error("URDF", str(error))
            return None
        if robot is None:
            if state.model is None:
                return None
            robot, full = state.model.robot, state.model.full
        choices = self._choices()
        enabled_links = tuple(link for link in robot.links if choices.of(link).enabled)
        return LoadedRobot(robot, full, self._placing(robot, samples, ctx), enabled_links)

    def _placing(self, robot: Robot, samples: Sequence[Sample], ctx: Context) -> Placing:
        state: RobotDrawing = ctx.state
        prefix = prefixed(self.tf_prefix, "")
        if self.joint_source == "Transforms":
            return ByTransforms(prefix)
        if state.placer is None or state.placer.robot is not robot:
            state.placer = JointPlacer(robot)
        received = samples[-1].message if samples else ReceivedRobot()
        return state.placer.place(prefix + robot.root, received, self._round(ctx))

    def _round(self, ctx: Context) -> int | None:
        """Return what changes when links that joint states place may move again."""
        if self.joint_source == "Transforms" or not self.update_interval:
            return None
        return ctx.frames.now_ns // max(round(self.update_interval * SECOND), 1)

    def _request(self, samples: Sequence[Sample], ctx: Context) -> LoadRequest | None:
        paths = tuple(self.package_paths)
        if self.description_source == "File":
            return self._request_file(self.description_file, ctx)
        if samples and (text := samples[-1].message.description) is not None:
            return LoadRequest(text=text, package_paths=paths)
        text = f"No robot description received on {self.description_topic.name}"
        remedy = "" if ctx.frames.buffer.recorded else " Start robot_state_publisher."
        ctx.warn("URDF", f"{text}.{remedy}")
        return None

    def _request_file(self, path: str, ctx: Context) -> LoadRequest | None:
        if not path:
            ctx.warn("URDF", "No description file is chosen. Enter its path in Description File.")
            return None
        written = ctx.state.written = last_written(path, ctx.state.written, ctx)
        if written.path != path:
            ctx.loading(f"Loading: waiting for the disk with {path}.")
            return None
        return LoadRequest(
            path=path, changed_ns=written.at_ns, package_paths=tuple(self.package_paths)
        )
