"""The PlanningScene display."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Annotated

import msgspec
from msgspec.structs import replace

from webviz import (
    Context,
    Details,
    Display,
    Hit,
    Lookback,
    Prop,
    ProtocolClient,
    Sample,
    Topic,
)
from webviz.api.connection import GraphConnection
from webviz.data.words import joined
from webviz_displays.moveit.asking import Asking
from webviz_displays.moveit.bodies import SLOW_BYTES
from webviz_displays.moveit.properties import (
    ROBOT_DESCRIPTION,
    MoveGroupNamespace,
    PlanningSceneTopic,
    RobotDescription,
    SceneGeometry,
    SceneRobot,
)
from webviz_displays.moveit.robots import Robots
from webviz_displays.moveit.scene import SINCE_WHOLE, KnownScene, updated
from webviz_displays.moveit.world import DrawnWorld, look_of


class ReceivedPlanningScene(msgspec.Struct, frozen=True):
    """Messages received about a scene.

    Args:
        description: URDF of the robot, None before the first.
        scene: the messages so far, None before the first.
    """

    description: str | None = None
    scene: KnownScene | None = None

    def with_sample(self, name: str, sample: Sample) -> ReceivedPlanningScene:
        """Return the same with a message of the input `name`."""
        if name == "robot_description":
            return replace(self, description=sample.message.data)
        return replace(self, scene=updated(self.scene or KnownScene(), sample.message))

    def scene_over(self, answer: KnownScene | None) -> KnownScene | None:
        """Return the scene, completed by move_group's answer where messages have changes only."""
        if self.scene is None or answer is None or self.scene.is_whole:
            return self.scene or answer
        return self.scene.over(answer)


@dataclass
class PlanningSceneDrawing:
    """State of what is drawn of a scene.

    Args:
        robots: the robot.
        asking: move_group.
        world: what is drawn.
    """

    robots: Robots = field(default_factory=Robots)
    asking: Asking = field(default_factory=Asking)
    world: DrawnWorld = field(init=False)

    def __post_init__(self) -> None:
        self.world = DrawnWorld(self.robots)


class PlanningScene(Display, ProtocolClient):
    """MoveIt's planning scene: objects, the robot, and the objects attached to it."""

    rviz = "moveit_rviz_plugin/PlanningScene"
    is_threaded = True
    slow_bytes = SLOW_BYTES

    planning_scene_topic: PlanningSceneTopic = Topic("/monitored_planning_scene")
    robot_description: RobotDescription = ROBOT_DESCRIPTION
    move_group_namespace: MoveGroupNamespace = ""
    scene_geometry: Annotated[SceneGeometry, Prop(help="How the objects look.")] = SceneGeometry()
    scene_robot: Annotated[SceneRobot, Prop(help="How the robot looks.")] = SceneRobot()

    def new_state(self) -> PlanningSceneDrawing:
        """Nothing."""
        return PlanningSceneDrawing()

    def waits(self, name: str) -> bool:
        """Scenes have no stamp."""
        return False

    def lookback(self, name: str) -> Lookback:
        """Return the newest description, and all changes since a whole scene."""
        return Lookback(count=1) if name == "robot_description" else SINCE_WHOLE

    def fold(
        self, name: str, sample: Sample, state: ReceivedPlanningScene | None
    ) -> ReceivedPlanningScene:
        """Apply each change to the scene."""
        return (state or ReceivedPlanningScene()).with_sample(name, sample)

    def communicate(self, connection: GraphConnection, ctx: Context) -> None:
        """Ask move_group for the whole scene."""
        state: PlanningSceneDrawing = ctx.state
        state.asking.step(self.move_group_namespace, connection, ctx)

    def depends(self, ctx: Context) -> object:
        """Return loading progress, the answer of move_group, and frames that objects wait for."""
        state: PlanningSceneDrawing = ctx.state
        structure = ctx.frames.structure, ctx.frames.fixed_frame
        late = state.world.is_late(self.scene_geometry.scene_display_time, ctx.frames.now_ns)
        return state.robots.progress(), state.asking.scene, state.asking.problem, structure, late

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Draw the newest scene."""
        state: PlanningSceneDrawing = ctx.state
        received: ReceivedPlanningScene = (
            samples[-1].message if samples else ReceivedPlanningScene()
        )
        state.robots.begin()
        collisions = self.scene_robot.show_robot_collision
        topic = self.robot_description.name
        state.robots.load(received.description, topic, collisions, ctx)
        scene = received.scene_over(state.asking.scene)
        if scene is None:
            ctx.warn("Scene", no_scene(self.planning_scene_topic.name, state.asking))
            return
        state.world.draw(scene, self.scene_geometry, self.scene_robot, ctx)

    def tick(self, ctx: Context) -> None:
        """Draw the trails of links."""
        state: PlanningSceneDrawing = ctx.state
        state.robots.follow(look_of(self.scene_robot), "", ctx)

    def inspect(self, hit: Hit, ctx: Context) -> Details | None:
        """Return an object, or a link of the robot."""
        state: PlanningSceneDrawing = ctx.state
        return state.world.inspect(hit) or state.robots.inspect(hit, ctx.frames)


def no_scene(topic: str, asking: Asking) -> str:
    """Return why no planning scene is shown, and what to do."""
    return joined(f"No planning scene received on {topic}", asking.problem, "Start move_group.")
