"""The RobotState display."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any

import msgspec

from webviz import Context, Details, Display, Hit, Input, Lookback, Prop, Rgb, Sample, Topic
from webviz.data.words import joined
from webviz_displays.moveit.bodies import SLOW_BYTES, named
from webviz_displays.moveit.drawing import HeldObjects, opacity_of, rgb_of, with_alpha
from webviz_displays.moveit.properties import (
    ATTACHED,
    ROBOT_DESCRIPTION,
    AllLinks,
    AttachedBodyColor,
    Links,
    RobotAlpha,
    RobotDescription,
    ShowCollision,
    ShowVisual,
)
from webviz_displays.moveit.robots import RobotLook, Robots
from webviz_displays.moveit.scene import KnownScene, updated_state
from webviz_displays.moveit.world import report_names


class ReceivedRobotState(msgspec.Struct, frozen=True):
    """Messages received about a robot state.

    Args:
        description: URDF of the robot, None before the first.
        scene: the state of the robot, None before the first.
        highlights: colours of links, 0 to 1.
        is_hidden: whether the publisher hides the robot.
    """

    description: str | None = None
    scene: KnownScene | None = None
    highlights: tuple[tuple[str, tuple[float, float, float, float]], ...] = ()
    is_hidden: bool = False


class RobotStateDrawing(msgspec.Struct):
    """State of what is drawn."""

    robots: Robots = msgspec.field(default_factory=Robots)
    attached: HeldObjects = msgspec.field(default_factory=HeldObjects)


class RobotState(Display):
    """A robot in a state that a program shows, such as an answer of inverse kinematics."""

    rviz = "moveit_rviz_plugin/RobotState"
    is_threaded = True
    slow_bytes = SLOW_BYTES

    robot_state_topic: Annotated[
        Topic,
        Input("moveit_msgs/msg/DisplayRobotState", is_plain=True),
        Prop(help="Topic of the states."),
    ] = Topic("display_robot_state")
    robot_description: RobotDescription = ROBOT_DESCRIPTION
    robot_alpha: RobotAlpha = 1.0
    attached_body_color: AttachedBodyColor = ATTACHED
    show_highlights: Annotated[
        bool, Prop(help="Draw links in the colours that the message gives them.")
    ] = True
    visual_enabled: ShowVisual = True
    collision_enabled: ShowCollision = False
    all_links_enabled: AllLinks = True
    links: Links = msgspec.field(default_factory=dict)

    def new_state(self) -> RobotStateDrawing:
        """Nothing."""
        return RobotStateDrawing()

    def waits(self, name: str) -> bool:
        """States have no stamp that matters."""
        return False

    def lookback(self, name: str) -> Lookback:
        """Return the newest description; all states, since they may tell changes only."""
        return Lookback(count=int(name == "robot_description"))

    def fold(
        self, name: str, sample: Sample, state: ReceivedRobotState | None
    ) -> ReceivedRobotState:
        """Remember the description; states may tell changes only."""
        before = state or ReceivedRobotState()
        message: Any = sample.message
        if name == "robot_description":
            return ReceivedRobotState(
                message.data, before.scene, before.highlights, before.is_hidden
            )
        scene = before.scene or KnownScene()
        highlights = tuple(
            (each.id, (each.color.r, each.color.g, each.color.b, each.color.a))
            for each in message.highlight_links
        )
        state_of = updated_state(scene, message.state)
        return ReceivedRobotState(before.description, state_of, highlights, bool(message.hide))

    def depends(self, ctx: Context) -> object:
        """Return loading progress."""
        return ctx.state.robots.progress()

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Draw the newest state."""
        state: RobotStateDrawing = ctx.state
        received: ReceivedRobotState = samples[-1].message if samples else ReceivedRobotState()
        robots = state.robots
        robots.begin()
        topic = self.robot_description.name
        model = robots.load(received.description, topic, self.collision_enabled, ctx)
        if received.scene is None:
            name = self.robot_state_topic.name
            ctx.warn("State", f"No state received on {name}. Start the program that shows it.")
            return
        if received.is_hidden:
            ctx.warn("State", "Hidden by the publisher.")
            return
        if model is None:
            return
        scene = received.scene
        stance = model.poser.stance(scene.joints)
        known_count = len(scene.joints.positions) + len(scene.joints.poses)
        report_names(known_count, stance.assumed, stance.unknown_joints, "The state", ctx)
        if scene.faults:
            ctx.warn("State", joined(*scene.faults[:3]))
        look = self._look(self._highlights(received, model.robot.links, ctx))
        frame = scene.frame or model.robot.root
        robots.draw(stance.poses, look, frame, "", ctx)
        robots.report(look, ctx)
        if self.visual_enabled or self.collision_enabled:
            rgba = with_alpha(self.attached_body_color, self.robot_alpha)
            unplaced = state.attached.draw(scene, stance.poses, rgba, frame, "", ctx)
            if unplaced:
                ctx.error(
                    "Objects", f"The link or frame of object {named(unplaced[0])} is unknown."
                )

    def tick(self, ctx: Context) -> None:
        """Draw the trails of links."""
        state: RobotStateDrawing = ctx.state
        state.robots.follow(self._look({}), "", ctx)

    def inspect(self, hit: Hit, ctx: Context) -> Details | None:
        """Return a link, or what the robot holds."""
        state: RobotStateDrawing = ctx.state
        return state.attached.inspect(hit) or state.robots.inspect(hit, ctx.frames)

    def _look(self, colors: dict[str, tuple[Rgb, float]]) -> RobotLook:
        return RobotLook(
            self.visual_enabled,
            self.collision_enabled,
            self.robot_alpha,
            self.links,
            self.all_links_enabled,
            colors=colors,
        )

    def _highlights(
        self, received: ReceivedRobotState, links: Any, ctx: Context
    ) -> dict[str, tuple[Rgb, float]]:
        """Colours of links that the robot has."""
        if not self.show_highlights:
            return {}
        valid = {link: rgba for link, rgba in received.highlights if _is_color(rgba)}
        unknown_links = [link for link, rgba in received.highlights if link not in links]
        if unknown_links:
            ctx.warn("Highlights", f"The robot has no link {named(unknown_links[0])}.")
        elif len(valid) < len({link for link, _ in received.highlights}):
            ctx.warn("Highlights", "A colour is not in 0 to 1. Fix the publisher.")
        return {
            link: (rgb_of(rgba), opacity_of(rgba)) for link, rgba in valid.items() if link in links
        }


def _is_color(rgba: Sequence[float]) -> bool:
    return all(0.0 <= part <= 1.0 for part in rgba)
