"""The MotionPlanningTasks display."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Annotated, Any

import msgspec

from webviz import (
    Color,
    Context,
    Details,
    Display,
    Hit,
    Input,
    Lookback,
    Prop,
    ProtocolClient,
    Sample,
    Topic,
)
from webviz.api.connection import GraphConnection
from webviz.data.words import counted
from webviz_displays.moveit.bodies import SLOW_BYTES, named
from webviz_displays.moveit.path_view import PREFIX, PathView, Playback
from webviz_displays.moveit.properties import (
    ATTACHED,
    OBJECTS,
    ROBOT_DESCRIPTION,
    AllLinks,
    AttachedBodyColor,
    InterruptDisplay,
    Links,
    LoopAnimation,
    Paused,
    Position,
    RobotAlpha,
    RobotDescription,
    SceneAlpha,
    SceneColor,
    SceneGeometry,
    SceneRobot,
    ShowCollision,
    ShowTrail,
    ShowVisual,
    StateDisplayTime,
    TrailStepSize,
    UseSimTime,
    VoxelColoring,
    VoxelRendering,
)
from webviz_displays.moveit.robots import RobotLook, Robots
from webviz_displays.moveit.solutions import (
    KnownSolution,
    ShownMarkers,
    SolutionRequest,
    known_solution,
)
from webviz_displays.moveit.tasks import MAX_TASKS, KnownTasks, TaskStage
from webviz_displays.moveit.world import DrawnWorld

LISTED = 40
"""Stages of a task that have a status."""
OFFERED = 200
"""Solutions that the panel offers."""
UNSEEN = SceneRobot(show_robot_visual=False, show_robot_collision=False)
"""The robot of a scene is drawn on its path."""
_MESSAGES = "moveit_task_constructor_msgs/msg"


class SolutionRobot(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Appearance of the robot on its path."""

    show_robot_visual: ShowVisual = True
    show_robot_collision: ShowCollision = False
    robot_alpha: RobotAlpha = 0.5
    fixed_robot_color: Annotated[
        Color, Prop(when=("use_fixed_robot_color", True), help="Colour of the robot.")
    ] = ATTACHED
    use_fixed_robot_color: Annotated[bool, Prop(help="Draw the robot in one colour.")] = False
    all_links_enabled: AllLinks = True
    links: Links = msgspec.field(default_factory=dict)


class SolutionScene(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Appearance of the scene at the point that is shown."""

    show_scene: Annotated[bool, Prop(rviz="Value", help="Draw the objects of the scene.")] = True
    scene_alpha: SceneAlpha = 0.9
    scene_color: SceneColor = OBJECTS
    attached_body_color: AttachedBodyColor = ATTACHED
    voxel_rendering: VoxelRendering = "Occupied Voxels"
    voxel_coloring: VoxelColoring = "Z-Axis"


class SolutionMarkers(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Markers that stages attach to their solutions."""

    show_markers: Annotated[bool, Prop(rviz="Value", help="Draw the markers.")] = True
    all_at_once: Annotated[
        bool,
        Prop(rviz="All at once?", help="Draw those of all trajectories, not of the current one."),
    ] = False


@dataclass
class TasksDrawing:
    """State of what is drawn."""

    robots: Robots = field(default_factory=Robots)
    request: SolutionRequest = field(default_factory=SolutionRequest)
    markers: ShownMarkers = field(default_factory=ShownMarkers)
    tasks: KnownTasks = field(default_factory=KnownTasks)
    solution: KnownSolution | None = None
    world: DrawnWorld = field(init=False)
    view: PathView = field(init=False)

    def __post_init__(self) -> None:
        self.world = DrawnWorld(self.robots)
        self.view = PathView(self.robots)

    def take(self, message: Any) -> KnownSolution | None:
        """Take the solution to play, None for none."""
        if message is None:
            self.solution = None
        elif self.solution is None or self.solution.message is not message:
            self.solution = known_solution(message)
        return self.solution


class MotionPlanningTasks(Display, ProtocolClient):
    """The stages of MoveIt Task Constructor's tasks, and a robot that plays a solution."""

    rviz = "moveit_task_constructor/Motion Planning Tasks"
    is_threaded = True
    slow_bytes = SLOW_BYTES

    task_solution_topic: Annotated[
        Topic,
        Input(f"{_MESSAGES}/Solution", is_plain=True, is_sporadic=True),
        Prop(help="Topic of the solutions, whose name ends in /solution."),
    ] = Topic("/solution")
    description_topic: Annotated[
        Topic,
        Input(f"{_MESSAGES}/TaskDescription", beside="description", optional=True, is_plain=True),
        Prop(help="Topic of the stages of tasks; empty means description beside the solutions."),
    ] = Topic()
    statistics_topic: Annotated[
        Topic,
        Input(f"{_MESSAGES}/TaskStatistics", beside="statistics", optional=True, is_plain=True),
        Prop(help="Topic of the numbers of solutions; empty means statistics beside them."),
    ] = Topic()
    robot_description: RobotDescription = ROBOT_DESCRIPTION
    solution: Annotated[
        int, Prop(ge=0, le=0xFFFFFFFF, help="Id of the solution to play; 0 is the newest.")
    ] = 0
    state_display_time: StateDisplayTime = "0.05 s"
    use_sim_time: UseSimTime = False
    loop_animation: LoopAnimation = False
    interrupt_display: InterruptDisplay = False
    show_trail: ShowTrail = False
    trail_step_size: TrailStepSize = 1
    paused: Paused = False
    position: Position = 1.0
    robot: Annotated[SolutionRobot, Prop(help="How the robot looks.")] = SolutionRobot()
    scene: Annotated[SolutionScene, Prop(help="How the scene looks.")] = SolutionScene()
    markers: Annotated[SolutionMarkers, Prop(help="Which markers to draw.")] = SolutionMarkers()

    def new_state(self) -> TasksDrawing:
        """Nothing."""
        return TasksDrawing()

    def waits(self, name: str) -> bool:
        """Solutions are played when they arrive."""
        return False

    def lookback(self, name: str) -> Lookback:
        """Return the newest solution, and what is known of each task."""
        several = name in ("description_topic", "statistics_topic")
        return Lookback(count=MAX_TASKS if several else 1)

    def fold(self, name: str, sample: Sample, state: KnownTasks | None) -> KnownTasks:
        """Remember stages and numbers of each task, and the newest solution."""
        return (state or KnownTasks()).with_message(name, sample.message)

    def communicate(self, connection: GraphConnection, ctx: Context) -> None:
        """Ask for the chosen solution, and for the next turn while the robot moves."""
        state: TasksDrawing = ctx.state
        task = state.tasks.task_of(self.solution) if self.solution else ""
        folder = self.task_solution_topic.name.rpartition("/")[0]
        service = f"{folder}/get_solution_{task}"
        state.request.step((service, self.solution) if task else None, connection)
        if state.view.player.is_moving:
            connection.wake()

    def depends(self, ctx: Context) -> object:
        """Return loading progress, frames, the answer, and the point of the path."""
        state: TasksDrawing = ctx.state
        point = state.view.advance(self._playback(), ctx.frames.now_ns)
        structure = ctx.frames.structure, ctx.frames.fixed_frame
        answer = state.request.solution, state.request.problem
        return state.robots.progress(), structure, answer, point, state.markers.version(ctx)

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Draw the stages of the tasks, and the solution to play."""
        state: TasksDrawing = ctx.state
        tasks = state.tasks = samples[-1].message if samples else KnownTasks()
        self._report_tasks(tasks, ctx)
        state.robots.begin()
        topic, collisions = self.robot_description.name, self.robot.show_robot_collision
        model = state.robots.load(tasks.description, topic, collisions, ctx)
        solution = state.take(state.request.solution if self.solution else tasks.solution)
        playback = self._playback()
        state.view.take(solution and solution.path, playback)
        state.view.advance(playback, ctx.frames.now_ns)
        if solution is None:
            self._report_missing(state.request, ctx)
            return
        part = solution.part_at(state.view.player.index)
        scene = solution.scenes[min(part, len(solution.scenes) - 1)]
        self._report_solution(solution, part, tasks, ctx)
        state.world.draw(scene, self._geometry(), UNSEEN, ctx)
        root = model.robot.root if model else ctx.frames.fixed_frame
        state.view.draw(playback, scene.frame or root, ctx, scene)
        if self.markers.show_markers:
            chosen = None if self.markers.all_at_once else part
            state.markers.draw((solution, chosen), solution.markers(chosen), ctx)

    def tick(self, ctx: Context) -> None:
        """Draw the trails of links."""
        state: TasksDrawing = ctx.state
        state.robots.follow(self._playback().look, PREFIX, ctx)

    def inspect(self, hit: Hit, ctx: Context) -> Details | None:
        """Return a link, an object of the scene, or a marker."""
        state: TasksDrawing = ctx.state
        details = state.view.inspect(hit, ctx) or state.world.inspect(hit)
        return details or state.markers.inspect(hit, ctx)

    def _playback(self) -> Playback:
        robot = self.robot
        look = RobotLook(
            robot.show_robot_visual,
            robot.show_robot_collision,
            robot.robot_alpha,
            robot.links,
            robot.all_links_enabled,
            robot.fixed_robot_color if robot.use_fixed_robot_color else None,
        )
        return Playback(
            look,
            self.state_display_time,
            by_shown_time=self.use_sim_time,
            loops=self.loop_animation,
            interrupts=self.interrupt_display,
            trail=self.show_trail,
            step=self.trail_step_size,
            share=self.position if self.paused else None,
            attached=self.scene.attached_body_color,
        )

    def _geometry(self) -> SceneGeometry:
        scene = self.scene
        return SceneGeometry(
            show_scene_geometry=scene.show_scene,
            scene_alpha=scene.scene_alpha,
            scene_color=scene.scene_color,
            voxel_rendering=scene.voxel_rendering,
            voxel_coloring=scene.voxel_coloring,
        )

    def _report_tasks(self, tasks: KnownTasks, ctx: Context) -> None:
        """Show the tree of stages of each task, the newest task first."""
        offered: dict[str, int] = {}
        solved: dict[str, int] = {}
        failed: dict[str, int] = {}
        several = len(tasks.plans) > 1
        for index, task in enumerate(reversed(list(tasks.plans)), start=1):
            for stage in tasks.stages(task):
                label = f"Task {index}: {stage.number}" if several else stage.number
                label = f"{label} {stage.name}"
                solved[label], failed[label] = len(stage.solved), stage.failed
                offered |= {f"{id}: {stage.name}": id for id in stage.solved}
                if len(solved) <= LISTED:
                    ctx.ok(label, f"{_counts(stage)}.")
        if len(solved) > LISTED:
            ctx.ok("More stages", f"{len(solved) - LISTED} more.")
        ctx.offered["stages"], ctx.offered["failed"] = solved, failed
        ctx.offered["solution"] = dict(list(offered.items())[:OFFERED])

    def _report_missing(self, request: SolutionRequest, ctx: Context) -> None:
        if not self.solution:
            name = self.task_solution_topic.name
            ctx.warn("Solution", f"No solution received on {name}. Plan a task, or choose one.")
        elif request.request is None:
            text = f"No task is known that has solution {self.solution}. Plan again, or choose 0."
            ctx.warn("Solution", text)
        elif request.problem:
            ctx.warn("Solution", f"Solution {self.solution}: {request.problem}")
        else:
            ctx.warn("Solution", f"Asking for solution {self.solution}.")

    def _report_solution(
        self, solution: KnownSolution, part: int, tasks: KnownTasks, ctx: Context
    ) -> None:
        info, parts = solution.info, solution.message.sub_trajectory
        if info is None:
            ctx.warn("Solution", "The solution is empty. Choose another one.")
            return
        comment = f" {info.comment[:200]}" if info.comment else ""
        ctx.ok(
            "Solution",
            f"Solution {info.id}: {counted(len(parts), 'part')}, cost {info.cost:.3g}.{comment}",
        )
        if part < len(parts):
            stage = parts[part].info
            ctx.ok("Stage", f"Part {part + 1} of {len(parts)}: {_name(stage, tasks)}.")


def _name(info: Any, tasks: KnownTasks) -> str:
    """Return the stage that made a trajectory."""
    for plan in reversed(list(tasks.plans.values())):
        for stage in plan.stages:
            if stage.id == info.stage_id:
                return named(stage.name)
    return f"stage {info.stage_id}"


def _counts(stage: TaskStage) -> str:
    failed = f", {stage.failed} failed" if stage.failed else ""
    time = f", {stage.time_s:.2f} s" if stage.time_s else ""
    return f"{counted(len(stage.solved), 'solution')}{failed}{time}"
