"""The MotionPlanning display."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Annotated, Any

import msgspec
import numpy as np
from msgspec.structs import replace

from webviz import (
    Context,
    Details,
    Display,
    Hit,
    Input,
    Lookback,
    Pose,
    Prop,
    ProtocolClient,
    Rgb,
    Sample,
    Topic,
)
from webviz.api.connection import GraphConnection
from webviz_displays.moveit.asking import Asking
from webviz_displays.moveit.bodies import SLOW_BYTES
from webviz_displays.moveit.joints import JointValues, joints_of
from webviz_displays.moveit.path_view import PREFIX, PathView, playback_of
from webviz_displays.moveit.paths import JointPath
from webviz_displays.moveit.planning_scene import ReceivedPlanningScene, no_scene
from webviz_displays.moveit.properties import (
    ROBOT_DESCRIPTION,
    MoveGroupNamespace,
    PlannedPath,
    PlanningRequest,
    PlanningSceneTopic,
    RobotDescription,
    SceneGeometry,
    SceneRobot,
    TrajectoryTopic,
)
from webviz_displays.moveit.robots import PosedRobot, RobotLook, Robots
from webviz_displays.moveit.scene import SINCE_WHOLE
from webviz_displays.moveit.world import DrawnWorld, look_of
from webviz_displays.shared.geometry import LONGEST

Triple = tuple[float, float, float]
_STATE = "moveit_msgs/msg/RobotState"


class Plans(msgspec.Struct, frozen=True):
    """Messages received about scene and plans.

    Args:
        received: description and scene.
        path: newest moveit_msgs/DisplayTrajectory.
        ends: joints that programs gave for the start and the goal, by the name of the input.
    """

    received: ReceivedPlanningScene = msgspec.field(default_factory=ReceivedPlanningScene)
    path: Any = None
    ends: tuple[tuple[str, JointValues], ...] = ()


@dataclass
class MotionPlanningDrawing:
    """State of what is drawn."""

    robots: Robots = field(default_factory=Robots)
    asking: Asking = field(default_factory=Asking)
    world: DrawnWorld = field(init=False)
    view: PathView = field(init=False)

    def __post_init__(self) -> None:
        self.world = DrawnWorld(self.robots)
        self.view = PathView(self.robots)


class MotionPlanning(Display, ProtocolClient):
    """The scene of MoveIt, the newest plan, and where it begins and ends."""

    rviz = "moveit_rviz_plugin/MotionPlanning"
    is_threaded = True
    slow_bytes = SLOW_BYTES

    planning_scene_topic: PlanningSceneTopic = Topic("/monitored_planning_scene")
    trajectory_topic: Annotated[
        TrajectoryTopic,
        Prop(rviz="Planned Path/Trajectory Topic", help="Topic of the planned paths."),
    ] = Topic("/display_planned_path")
    robot_description: RobotDescription = ROBOT_DESCRIPTION
    start_state_topic: Annotated[
        Topic,
        Input(_STATE, optional=True, is_plain=True, is_offered=False),
        Prop(help="Topic on which programs set the start of the next plan."),
    ] = Topic("/rviz/moveit/update_custom_start_state")
    goal_state_topic: Annotated[
        Topic,
        Input(_STATE, optional=True, is_plain=True, is_offered=False),
        Prop(help="Topic on which programs set the goal of the next plan."),
    ] = Topic("/rviz/moveit/update_custom_goal_state")
    move_group_namespace: MoveGroupNamespace = ""
    scene_geometry: Annotated[SceneGeometry, Prop(help="How the objects look.")] = SceneGeometry()
    scene_robot: Annotated[SceneRobot, Prop(help="How the robot looks.")] = SceneRobot()
    planning_request: Annotated[PlanningRequest, Prop(help="How the ends of a plan look.")] = (
        PlanningRequest()
    )
    planned_path: Annotated[PlannedPath, Prop(help="How the path is played.")] = PlannedPath()
    workspace_center: Annotated[
        Triple, Prop(rviz="MoveIt_Workspace/Center", unit="m", help="Centre of the workspace.")
    ] = (0.0, 0.0, 0.0)
    workspace_size: Annotated[
        Triple, Prop(rviz="MoveIt_Workspace/Size", unit="m", help="Edges of the workspace.")
    ] = (2.0, 2.0, 2.0)

    def new_state(self) -> MotionPlanningDrawing:
        """Nothing."""
        return MotionPlanningDrawing()

    def waits(self, name: str) -> bool:
        """Neither scenes nor paths wait for transforms."""
        return False

    def lookback(self, name: str) -> Lookback:
        """All changes since a whole scene, and the newest of everything else."""
        return SINCE_WHOLE if name == "planning_scene_topic" else Lookback(count=1)

    def fold(self, name: str, sample: Sample, state: Plans | None) -> Plans:
        """Apply each change to the scene, and remember the newest plan."""
        before = state or Plans()
        if name == "trajectory_topic":
            return replace(before, path=sample.message, ends=())
        if name in ("start_state_topic", "goal_state_topic"):
            ends = {**dict(before.ends), name: joints_of(sample.message)}
            return replace(before, ends=tuple(ends.items()))
        return replace(before, received=before.received.with_sample(name, sample))

    def communicate(self, connection: GraphConnection, ctx: Context) -> None:
        """Ask move_group for the whole scene, and for the next turn while the robot moves."""
        state: MotionPlanningDrawing = ctx.state
        state.asking.step(self.move_group_namespace, connection, ctx)
        if state.view.player.is_moving:
            connection.wake()

    def depends(self, ctx: Context) -> object:
        """Return loading progress, the scene of move_group, frames, and the point of the path."""
        state: MotionPlanningDrawing = ctx.state
        point = state.view.advance(self._playback(), ctx.frames.now_ns)
        late = state.world.is_late(self.scene_geometry.scene_display_time, ctx.frames.now_ns)
        structure = ctx.frames.structure, ctx.frames.fixed_frame
        asking = state.asking
        return state.robots.progress(), asking.scene, asking.problem, structure, point, late

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Draw the newest scene and plan."""
        state: MotionPlanningDrawing = ctx.state
        plans: Plans = samples[-1].message if samples else Plans()
        robots, received = state.robots, plans.received
        robots.begin()
        collisions = self.scene_robot.show_robot_collision or self.planned_path.show_robot_collision
        topic = self.robot_description.name
        model = robots.load(received.description, topic, collisions, ctx)
        scene = received.scene_over(state.asking.scene)
        if scene is None:
            ctx.warn("Scene", no_scene(self.planning_scene_topic.name, state.asking))
        else:
            state.world.draw(scene, self.scene_geometry, self.scene_robot, ctx)
        playback = self._playback()
        state.view.take(plans.path, playback)
        state.view.advance(playback, ctx.frames.now_ns)
        frame = (scene and scene.frame) or (model.robot.root if model else ctx.frames.fixed_frame)
        state.view.draw(playback, frame, ctx)
        if model is not None:
            self._draw_ends(plans, state.view.newest, model, frame, ctx)
        if self.planning_request.show_workspace:
            self._draw_workspace(frame, ctx)
        ctx.ok(
            "Planning",
            "Scenes and plans are shown; planning itself is not supported. Plan in RViz or by a "
            "program.",
        )

    def tick(self, ctx: Context) -> None:
        """Draw the trails of links."""
        state: MotionPlanningDrawing = ctx.state
        look, prefix = look_of(self.scene_robot), ""
        if not look.links:
            look, prefix = self._playback().look, PREFIX
        state.robots.follow(look, prefix, ctx)

    def inspect(self, hit: Hit, ctx: Context) -> Details | None:
        """Return an object, or a link of one of the robots."""
        state: MotionPlanningDrawing = ctx.state
        return state.world.inspect(hit) or state.view.inspect(hit, ctx)

    def _playback(self) -> Any:
        return playback_of(self.planned_path, self.scene_robot.attached_body_color, "planned_path.")

    def _draw_ends(
        self, plans: Plans, path: JointPath | None, model: PosedRobot, frame: str, ctx: Context
    ) -> None:
        """Draw the robot at the start and at the goal of the newest plan."""
        request = self.planning_request
        ends = (
            (
                "start",
                request.query_start_state,
                request.start_state_color,
                request.start_state_alpha,
            ),
            ("goal", request.query_goal_state, request.goal_state_color, request.goal_state_alpha),
        )
        for name, is_shown, color, alpha in ends:
            if not is_shown:
                continue
            joints = dict(plans.ends).get(f"{name}_state_topic")
            if joints is None and path is not None and len(path):
                joints = _joints_at(path, 0 if name == "start" else -1, model)
            if joints is None:
                ctx.ok(
                    f"{name.capitalize()} state",
                    "None so far. Plan a path, or publish a state on "
                    f"{getattr(self, f'{name}_state_topic').name}.",
                )
                continue
            self._draw_end(name, joints, path, (color, alpha), model, frame, ctx)

    def _draw_end(
        self,
        name: str,
        joints: JointValues,
        path: JointPath | None,
        paint: tuple[Rgb, float],
        model: PosedRobot,
        frame: str,
        ctx: Context,
    ) -> None:
        stance = model.poser.stance(joints)
        moving = path.moving if path is not None and path.moving else tuple(model.robot.joints)
        leaders = [name for name in moving if name in model.poser.columns]
        color, alpha = paint
        colors = dict.fromkeys(model.poser.kinematics.moved_by(leaders), (color, 1.0))
        outside = self.planning_request.joint_violation_color
        colors |= dict.fromkeys(stance.outside, (outside, 1.0))
        look = RobotLook(alpha=alpha, colors=colors)
        state: MotionPlanningDrawing = ctx.state
        state.robots.draw(stance.poses, look, joints.frame or frame, f"{name} ", ctx)
        key = f"{name.capitalize()} state"
        if stance.outside:
            links = ", ".join(stance.outside[:3])
            ctx.warn(key, f"Joints are outside their limits: those of {links}.")
        else:
            ctx.ok(key, f"{len(joints.positions)} joints.")

    def _draw_workspace(self, frame: str, ctx: Context) -> None:
        size = np.clip(np.abs(self.workspace_size), 0.0, LONGEST) / 2.0
        corners = np.array(np.meshgrid(*([(-1.0, 1.0)] * 3))).T.reshape(-1, 3)
        pairs = [
            (i, j)
            for i in range(8)
            for j in range(i + 1, 8)
            if (corners[i] != corners[j]).sum() == 1
        ]
        x, y, z = np.clip(self.workspace_center, -LONGEST, LONGEST).tolist()
        group = ctx.follow(frame, offset=Pose((x, y, z)), key="workspace")
        group.lines("workspace", corners[np.array(pairs)] * size, (0, 150, 150))


def _joints_at(path: JointPath, index: int, model: PosedRobot) -> JointValues:
    values = dict(zip(model.poser.columns, path.values[index].tolist(), strict=True))
    return JointValues(values, path.poses[index], path.frame)
