"""Drawing of a planning scene: its objects, its robot, and what the robot holds."""

from __future__ import annotations

from collections.abc import Mapping

import msgspec

from webviz import Context, Details, Hit, Pose
from webviz.data.words import counted, joined, listed
from webviz_displays.moveit.bodies import Body, named
from webviz_displays.moveit.drawing import (
    DrawnObjects,
    HeldObjects,
    ShownObject,
    body_details,
    draw_objects,
    owner_of,
    with_alpha,
)
from webviz_displays.moveit.joints import JointValues, Poser, Stance
from webviz_displays.moveit.octomap import Octomap
from webviz_displays.moveit.properties import SceneGeometry, SceneRobot
from webviz_displays.moveit.robots import RobotLook, Robots
from webviz_displays.moveit.scene import KnownScene, Rgba

NAMED = 5
"""Objects, joints and faults that are listed."""
MAX_AT_ONCE = 500
"""Objects that are drawn without a thread."""
NOTHING = DrawnObjects((), {})
NO_LINKS: Mapping[str, Pose] = {}


class _Look(msgspec.Struct, frozen=True, eq=False):
    """Inputs that the nodes of objects depend on.

    Args:
        world: the objects and their poses in the frame of the scene.
        colors: by id.
        default: colour of the others.
    """

    world: Mapping[str, tuple[Body, Pose]]
    colors: Mapping[str, Rgba]
    default: Rgba

    def is_of(self, world: object, colors: object, default: Rgba) -> bool:
        """Return whether nothing has changed."""
        return self.world is world and self.colors is colors and self.default == default

    def nodes(self) -> DrawnObjects:
        """Return the nodes."""
        return draw_objects(
            [
                ShownObject(body, pose, self.colors.get(key, self.default))
                for key, (body, pose) in self.world.items()
            ],
            "object ",
        )


class DrawnWorld(msgspec.Struct):
    """Drawn part of a scene.

    Args:
        robots: draw its robot.
        owners: objects by the keys of nodes.
        attached: what the robot holds.
        octomap: that of the scene.
        scene: that is drawn.
        frame: of the scene.
    """

    robots: Robots
    owners: Mapping[str, object] = msgspec.field(default_factory=dict)
    attached: HeldObjects = msgspec.field(default_factory=HeldObjects)
    octomap: Octomap = msgspec.field(default_factory=Octomap)
    scene: KnownScene = msgspec.field(default_factory=KnownScene)
    frame: str = ""
    _look: _Look | None = None
    _cache: tuple[_Look | None, DrawnObjects] = None, NOTHING
    _stance: tuple[Poser, JointValues, int, Stance] | None = None
    _seen_ns: int = 0
    _is_still: bool = False

    def is_late(self, interval_s: float, now_ns: int) -> bool:
        """Return whether the robot may move now to where the scene has it.

        While time stands still, as after a seek in a recording, it may at once: what is shown then
        depends on that time alone.
        """
        self._is_still, self._seen_ns = now_ns == self._seen_ns, now_ns
        if self._stance is None or self._stance[1] is self.scene.joints:
            return False
        return self._is_due(self._stance[2], now_ns, interval_s)

    def _is_due(self, before_ns: int, now_ns: int, interval_s: float) -> bool:
        """Return whether the robot may move, or time was set back or stands still."""
        return self._is_still or not 0 <= now_ns - before_ns < interval_s * 1e9

    def draw(
        self, scene: KnownScene, geometry: SceneGeometry, robot: SceneRobot, ctx: Context
    ) -> None:
        """Draw a scene.

        Args:
            scene: to draw.
            geometry: how its objects look.
            robot: how its robot looks.
            ctx: receives nodes and statuses.
        """
        model = self.robots.model
        self.scene = scene
        frame = self.frame = scene.frame or (model.robot.root if model else ctx.frames.fixed_frame)
        links = NO_LINKS
        if model is not None:
            stance = self._posed(model.poser, geometry.scene_display_time, ctx.frames.now_ns)
            links = stance.poses
            report_joints(scene, stance.assumed, stance.unknown_joints, ctx)
        look = look_of(robot)
        self.robots.draw(links, look, frame, "", ctx)
        self.robots.report(look, ctx)
        unplaced = self.attached.places.update(scene, frame, links, ctx.frames)
        self.owners = {}
        if geometry.show_scene_geometry:
            color = with_alpha(geometry.scene_color, geometry.scene_alpha)
            nodes = self._objects(scene, color, ctx)
            nodes.add(frame, ctx)
            self.owners = nodes.owners
            looks = geometry.voxel_rendering, geometry.voxel_coloring, geometry.scene_alpha
            self.octomap.draw(scene, self.attached.places, links, looks, frame, ctx)
        lost_held: list[str] = []
        if robot.show_robot_visual or robot.show_robot_collision:
            color = with_alpha(robot.attached_body_color, robot.robot_alpha)
            lost_held = self.attached.draw(scene, links, color, frame, "", ctx)
        report_objects(scene, unplaced, lost_held, ctx)

    def _objects(self, scene: KnownScene, default: Rgba, ctx: Context) -> DrawnObjects:
        """Return the objects as nodes, made anew only if one of them or its colour has changed.

        Many are made in a thread; until then the previous ones stay.
        """
        world = self.attached.places.world
        look = self._look
        if look is None or not look.is_of(world, scene.colors, default):
            look = self._look = _Look(world, scene.colors, default)
        if self._cache[0] is not look:
            if len(world) <= MAX_AT_ONCE:
                self._cache = look, look.nodes()
            elif (objects := ctx.background(look, look.nodes)) is not None:
                self._cache = look, objects
        return self._cache[1]

    def _posed(self, poser: Poser, interval_s: float, now_ns: int) -> Stance:
        """Return where the links are, computed anew after some time at the earliest."""
        joints, before = self.scene.joints, self._stance
        if (
            before is not None
            and before[0] is poser
            and (before[1] is joints or not self._is_due(before[2], now_ns, interval_s))
        ):
            return before[3]
        self._stance = poser, joints, now_ns, poser.stance(joints)
        return self._stance[3]

    def inspect(self, hit: Hit) -> Details | None:
        """Return an object, by one of its shapes."""
        body = owner_of(hit, self.owners)
        if body is None:
            return self.attached.inspect(hit) or self.octomap.inspect(hit)
        place = self.attached.places.world.get(body.id)
        return body_details(body, {f"Pose in {self.frame}": place[1]} if place else {})


def look_of(robot: SceneRobot) -> RobotLook:
    """Return the appearance of the robot of a scene."""
    return RobotLook(
        robot.show_robot_visual,
        robot.show_robot_collision,
        robot.robot_alpha,
        robot.links,
        robot.all_links_enabled,
    )


def report_joints(
    scene: KnownScene, assumed: tuple[str, ...], unknown_joints: tuple[str, ...], ctx: Context
) -> None:
    """Report joints that the scene or the robot does not know."""
    known_count = len(scene.joints.positions) + len(scene.joints.poses)
    report_names(known_count, assumed, unknown_joints, "The scene", ctx)


def report_names(
    count: int, assumed: tuple[str, ...], unknown_joints: tuple[str, ...], what: str, ctx: Context
) -> None:
    """Report joints that a message or the robot does not know.

    Args:
        count: joints with a position.
        assumed: joints without one.
        unknown_joints: joints that the robot does not have.
        what: the message.
        ctx: receives the status.
    """
    if unknown_joints:
        names = listed([named(name) for name in unknown_joints], NAMED)
        ctx.warn(
            "Joints", f"The robot has no joint {names}. Check that its URDF is that of the message."
        )
    elif assumed:
        ctx.warn(
            "Joints",
            f"{what} has no position for {counted(len(assumed), 'joint')}: "
            f"{listed(list(assumed), NAMED)}. They stay at their default.",
        )
    else:
        ctx.ok("Joints", f"The positions of {counted(count, 'joint')} are known.")


def report_objects(
    scene: KnownScene, unplaced: list[Body], lost_held: list[str], ctx: Context
) -> None:
    """Report how many objects there are, and which cannot be drawn."""
    name = f"{named(scene.name)}: " if scene.name else ""
    count = len(scene.objects)
    attached = f", {len(scene.attached)} attached" if scene.attached else ""
    ctx.ok("Scene", f"{name}{counted(count, 'object')}{attached}.")
    faults = list(scene.faults)
    for body in (*scene.objects.values(), *(each.body for each in scene.attached.values())):
        faults += body.faults
        if len(faults) > NAMED:
            break
    if unplaced:
        first = unplaced[0]
        ctx.error(
            "Object frames",
            f"{counted(len(unplaced), 'object')} in an unknown frame, such as {named(first.id)} in "
            f"{named(first.frame)}. Publish its transform, or give it in the frame of the scene.",
        )
    elif lost_held:
        link = scene.attached[lost_held[0]].link
        ctx.error(
            "Object frames",
            f"{counted(len(lost_held), 'attached object')} without the pose of the link, such as "
            f"{named(lost_held[0])} at {named(link)}. Check the URDF.",
        )
    if faults:
        more = " And more." if len(faults) > NAMED else ""
        ctx.warn("Objects", joined(*faults[:NAMED]) + more)
