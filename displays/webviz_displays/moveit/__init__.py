"""The displays of MoveIt: planning scenes, states and trajectories of a robot."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import msgspec

from webviz import (
    Context,
    Details,
    Display,
    Hit,
    ProtocolClient,
    Sample,
    Topic,
)
from webviz.api.connection import GraphConnection
from webviz_displays.moveit.motion_planning import MotionPlanning
from webviz_displays.moveit.path_view import PREFIX, PathView, playback_of
from webviz_displays.moveit.planning_scene import PlanningScene
from webviz_displays.moveit.planning_tasks import MotionPlanningTasks
from webviz_displays.moveit.properties import (
    ATTACHED,
    ROBOT_DESCRIPTION,
    AllLinks,
    ColorEnabled,
    InterruptDisplay,
    Links,
    LoopAnimation,
    Paused,
    Position,
    RobotAlpha,
    RobotColor,
    RobotDescription,
    ShowCollision,
    ShowTrail,
    ShowVisual,
    StateDisplayTime,
    TrailStepSize,
    TrajectoryTopic,
    UseSimTime,
)
from webviz_displays.moveit.robot_state import RobotState
from webviz_displays.moveit.robots import Robots

__all__ = ["MotionPlanning", "MotionPlanningTasks", "PlanningScene", "RobotState", "Trajectory"]


@dataclass
class TrajectoryDrawing:
    """State of what is drawn."""

    robots: Robots = field(default_factory=Robots)
    view: PathView = field(init=False)

    def __post_init__(self) -> None:
        self.view = PathView(self.robots)


class Trajectory(Display, ProtocolClient):
    """A robot on its planned path."""

    rviz = "moveit_rviz_plugin/Trajectory"

    trajectory_topic: TrajectoryTopic = Topic("/display_planned_path")
    robot_description: RobotDescription = ROBOT_DESCRIPTION
    show_robot_visual: ShowVisual = True
    show_robot_collision: ShowCollision = False
    robot_alpha: RobotAlpha = 0.5
    state_display_time: StateDisplayTime = "3x"
    use_sim_time: UseSimTime = False
    loop_animation: LoopAnimation = False
    show_trail: ShowTrail = False
    trail_step_size: TrailStepSize = 1
    interrupt_display: InterruptDisplay = False
    robot_color: RobotColor = ATTACHED
    color_enabled: ColorEnabled = False
    paused: Paused = False
    position: Position = 1.0
    all_links_enabled: AllLinks = True
    links: Links = msgspec.field(default_factory=dict)

    def new_state(self) -> TrajectoryDrawing:
        """Nothing."""
        return TrajectoryDrawing()

    def waits(self, name: str) -> bool:
        """Paths are played when they arrive."""
        return False

    def communicate(self, connection: GraphConnection, ctx: Context) -> None:
        """Ask for the next turn while the robot moves."""
        state: TrajectoryDrawing = ctx.state
        if state.view.player.is_moving:
            connection.wake()

    def depends(self, ctx: Context) -> object:
        """Return loading progress, and the point of the path."""
        state: TrajectoryDrawing = ctx.state
        return state.robots.progress(), state.view.advance(playback_of(self), ctx.frames.now_ns)

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Draw the robot at the current point."""
        state: TrajectoryDrawing = ctx.state
        newest = {sample.input: sample.message for sample in samples}
        description, path = newest.get("robot_description"), newest.get("trajectory_topic")
        robots, playback = state.robots, playback_of(self)
        robots.begin()
        text, topic = description and description.data, self.robot_description.name
        model = robots.load(text, topic, self.show_robot_collision, ctx)
        state.view.take(path, playback)
        state.view.advance(playback, ctx.frames.now_ns)
        if path is None:
            name = self.trajectory_topic.name
            ctx.warn("Path", f"No path received on {name}. Plan one with MoveIt.")
        state.view.draw(playback, model.robot.root if model else "", ctx)

    def tick(self, ctx: Context) -> None:
        """Draw the trails of links."""
        state: TrajectoryDrawing = ctx.state
        state.robots.follow(playback_of(self).look, PREFIX, ctx)

    def inspect(self, hit: Hit, ctx: Context) -> Details | None:
        """Return a link, or what the robot holds."""
        state: TrajectoryDrawing = ctx.state
        return state.view.inspect(hit, ctx)
