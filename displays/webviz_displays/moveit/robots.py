"""A robot that displays of MoveIt draw, once or several times, in the poses they want."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import msgspec

from webviz import Context, Details, Frames, Hit, Pose, Rgb, compose
from webviz_displays.moveit.joints import Poser
from webviz_displays.robot_model.details import TRAIL, link_details
from webviz_displays.robot_model.loading import Loadings, load, progress
from webviz_displays.robot_model.parts import Choices, LinkSettings, Paint, parts_of
from webviz_displays.robot_model.statuses import report_link, report_robot, report_unknown
from webviz_displays.shared.trails import Trails
from webviz_urdf import LoadRequest, Robot, RobotDescriptionError

NAMED = 5
"""Links whose poses are reported."""


class PosedRobot(msgspec.Struct, frozen=True, eq=False):
    """A loaded robot.

    Args:
        robot: without collision shapes.
        full: with them; None if they are not wanted or still loading.
        poser: places its links.
    """

    robot: Robot
    full: Robot | None
    poser: Poser


class RobotLook(msgspec.Struct, frozen=True):
    """Appearance of a robot.

    Args:
        visual, collision: which shapes.
        alpha: opacity.
        links: settings of single links.
        all_links: whether to draw the links without settings.
        color: of all links, None for their own.
        colors: of single links, with an opacity that is multiplied by theirs.
    """

    visual: bool = True
    collision: bool = False
    alpha: float = 1.0
    links: Mapping[str, LinkSettings] = msgspec.field(default_factory=dict)
    all_links: bool = True
    color: Rgb | None = None
    colors: Mapping[str, tuple[Rgb, float]] = msgspec.field(default_factory=dict)

    @property
    def choices(self) -> Choices:
        """The same for RobotModel's parts."""
        links = dict(self.links)
        for link, (_, alpha) in self.colors.items():
            before = links.get(link) or LinkSettings(enabled=self.all_links)
            links[link] = msgspec.structs.replace(before, alpha=before.alpha * alpha)
        return Choices(
            self.visual, self.collision, False, False, self.alpha, links, {}, self.all_links
        )

    def color_of(self, link: str) -> Rgb | None:
        """Return the colour of a link, None for its own."""
        return self.colors[link][0] if link in self.colors else self.color


class Robots(msgspec.Struct):
    """The robots of one display.

    Args:
        loading: what is being loaded.
        model: None until one is loaded.
        paint: the colours of parts.
        owners: link of each node by its key.
        placed: poses of links by the key of the group, with their frame.
        trails: of links, in `trails_frame`.
        trails_frame: fixed frame.
    """

    loading: Loadings = msgspec.field(default_factory=dict)
    model: PosedRobot | None = None
    paint: Paint = msgspec.field(default_factory=Paint)
    owners: dict[str, tuple[str, str]] = msgspec.field(default_factory=dict)
    placed: dict[str, tuple[str, Pose]] = msgspec.field(default_factory=dict)
    trails: Trails = msgspec.field(default_factory=Trails)
    trails_frame: str = ""

    def progress(self) -> object:
        """Return what changes while a robot is being loaded."""
        return [progress(each) for each in self.loading.values()]

    def load(
        self, text: str | None, topic: str, collisions: bool, ctx: Context
    ) -> PosedRobot | None:
        """Return the described robot, the previous one until it is loaded.

        `ctx.state.robots` is this.

        Args:
            text: the URDF, None if there is none.
            topic: where it should come from.
            collisions: whether collision shapes are wanted.
            ctx: receives the statuses.
        """
        before, self.loading = self.loading, {}
        if text is None:
            ctx.warn(
                "URDF", f"No robot description received on {topic}. Start robot_state_publisher."
            )
            return None
        request = LoadRequest(text=text)
        try:
            robot = load(request, before, ctx, self.loading)
            full = None
            if collisions:
                full = load(replace(request, collisions=True), before, ctx, self.loading)
        except RobotDescriptionError as error:
            ctx.error("URDF", str(error))
            self.model = None
            return None
        if robot is not None:
            is_known = self.model is not None and self.model.robot is robot
            poser = self.model.poser if is_known and self.model else Poser(robot)
            self.model = PosedRobot(robot, full, poser)
        if self.model is not None:
            report_robot(self.model.robot, self.model.full, ctx)
        return self.model

    def begin(self) -> None:
        """Start a round of drawing."""
        self.paint.begin()
        self.owners.clear()
        self.placed.clear()

    def draw(
        self, poses: Mapping[str, Pose], look: RobotLook, frame: str, prefix: str, ctx: Context
    ) -> None:
        """Draw the robot once.

        Args:
            poses: of its links in `frame`; others are not drawn.
            look: how.
            frame: that places it.
            prefix: begins the keys of the nodes.
            ctx: receives the nodes.
        """
        model = self.model
        if model is None:
            return
        for part in parts_of(model.robot, model.full, look.choices, self.paint):
            if part.link not in poses:
                continue
            place = prefix + part.link
            group = ctx.follow(frame, offset=poses[part.link], key=place)
            node = self.paint(part.node, color=look.color_of(part.link))
            group.add(prefix + part.key, node, part.pose)
            self.owners[prefix + part.key] = place, part.link
            self.placed[place] = frame, poses[part.link]

    def report(self, look: RobotLook, ctx: Context) -> None:
        """Report settings of links that the robot does not have."""
        if self.model is not None:
            report_unknown("Link", list(look.links), list(self.model.robot.links), ctx)

    def follow(self, look: RobotLook, prefix: str, ctx: Context) -> None:
        """Draw the trails of links and report their poses."""
        if self.trails_frame != ctx.frames.fixed_frame:
            self.trails, self.trails_frame = Trails(), ctx.frames.fixed_frame
        links = look.links.items()
        trails = {link: self._pose(prefix + link, ctx.frames) for link, s in links if s.show_trail}
        self.trails.update({link: pose and pose.position for link, pose in trails.items()})
        self.trails.draw(ctx)
        for link in [link for link, settings in links if settings.show_axes][:NAMED]:
            if pose := self._pose(prefix + link, ctx.frames):
                report_link(link, pose, ctx)

    def inspect(self, hit: Hit, frames: Frames) -> Details | None:
        """Return a link, by one of its shapes or its trail."""
        model = self.model
        trail = hit.key.removesuffix(TRAIL)
        place, link = self.owners.get(hit.key) or (trail, trail)
        if model is None or link not in model.robot.links:
            return None
        frame = self.placed[place][0] if place in self.placed else ""
        pose = self._pose(place, frames)
        return link_details(model.full or model.robot, link, pose, frame, frames)

    def _pose(self, place: str, frames: Frames) -> Pose | None:
        if place not in self.placed:
            return None
        frame, pose = self.placed[place]
        base = frames.latest(frame)
        return base and compose(base, pose)
