"""Drawing of a path: the robot on its way, and where it was."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import msgspec
import numpy as np

from webviz import Context, Details, Hit, Remedy, Rgb
from webviz.data.words import counted, joined, listed
from webviz_displays.moveit.bodies import named
from webviz_displays.moveit.drawing import HeldObjects, with_alpha
from webviz_displays.moveit.joints import Poser
from webviz_displays.moveit.paths import JointPath, path_of
from webviz_displays.moveit.properties import ATTACHED
from webviz_displays.moveit.robots import RobotLook, Robots
from webviz_displays.moveit.scene import KnownScene
from webviz_displays.moveit.trail import MAX_STATES, PathTrail

DEFAULT_SPEED = "3x"


class Speed(NamedTuple):
    """Speed of the animation of a path.

    Attributes:
        factor: of its own time, or 0.
        state_s: seconds for each of its points, or 0.
    """

    factor: float = 3.0
    state_s: float = 0.0

    def ahead(self, path: JointPath, place: float, seconds: float) -> float:
        """Return the place after some time.

        A place is the number of a point, and parts to the next.
        """
        if self.state_s:
            return place + seconds / self.state_s
        numbers = np.arange(len(path))
        time_s = float(np.interp(place, numbers, path.times)) + seconds * self.factor
        if time_s > path.times[-1]:
            return float(len(path))
        return float(np.interp(time_s, path.times, numbers))


def speed_of(text: str) -> Speed | None:
    """Return a speed as MoveIt writes it: "3x", "0.05 s" or "REALTIME"; None if it is invalid."""
    words = text.strip()
    if words.upper() == "REALTIME":
        return Speed(1.0, 0.0)
    try:
        value = float(words[:-1])
    except ValueError:
        return None
    if not 0.0 < value < math.inf or words[-1] not in "xs":
        return None
    return Speed(value, 0.0) if words[-1] == "x" else Speed(0.0, value)


class PathPlayer(msgspec.Struct):
    """Plays the newest path.

    Args:
        path: that is played, None before the first.
        place: in it; see `Speed.ahead`.
        is_moving: whether the animation goes on.
    """

    path: JointPath | None = None
    place: float = 0.0
    is_moving: bool = False
    _newest: JointPath | None = None
    _clock_s: float = 0.0

    @property
    def index(self) -> int:
        """The number of the point that is shown."""
        return min(int(self.place), len(self.path) - 1) if self.path else 0

    def take(self, path: JointPath | None, interrupts: bool) -> None:
        """Take the newest path, to be played now or after the current one."""
        if path is None:
            self.path, self._newest, self.is_moving = None, None, False
        elif path is not self._newest:
            self._newest = path
            if interrupts or not self.is_moving:
                self._start(path)

    def step(self, clock_s: float, speed: Speed, loops: bool) -> None:
        """Go on to a time, in seconds."""
        passed, self._clock_s = max(clock_s - self._clock_s, 0.0), clock_s
        if self.path is None or not (self.is_moving or loops):
            return
        if not self.is_moving:
            self._start(self.path)
        elif passed:
            self.place = speed.ahead(self.path, self.place, passed)
        if self.place < len(self.path):
            return
        if self._newest is not None and self._newest is not self.path:
            self._start(self._newest)
        elif loops:
            self._start(self.path)
        else:
            self.place, self.is_moving = float(len(self.path) - 1), False

    def hold(self, share: float) -> None:
        """Show the point at a share of the newest path, 0 to 1."""
        if self._newest is not None:
            self.path, self.is_moving = self._newest, False
            self.place = float(round(share * (len(self._newest) - 1)))

    def _start(self, path: JointPath) -> None:
        self.path, self.place, self.is_moving = path, 0.0, len(path) > 0


SECOND = 1_000_000_000
NAMED = 5
PREFIX = "path "


class Playback(msgspec.Struct, frozen=True):
    """Playback of a path, from the properties of a display.

    Args:
        look: of the robot.
        speed: as MoveIt writes it.
        by_shown_time: whether the time that is shown counts.
        loops, interrupts: see the properties.
        trail: whether there is one.
        step: points between its states.
        share: of the point that is held, None to play.
        attached: colour of what the robot holds.
        speed_path: of the property that says the speed.
    """

    look: RobotLook
    speed: str
    by_shown_time: bool
    loops: bool
    interrupts: bool
    trail: bool
    step: int
    share: float | None
    attached: Rgb = ATTACHED
    speed_path: str = "state_display_time"


def playback_of(path: Any, attached: Rgb = ATTACHED, above: str = "") -> Playback:
    """Return the playback that the properties of Trajectory or of a planned path choose.

    Args:
        path: has the properties.
        attached: colour of what the robot holds.
        above: the path of the properties in their display, such as "planned_path.".
    """
    look = RobotLook(
        path.show_robot_visual,
        path.show_robot_collision,
        path.robot_alpha,
        path.links,
        path.all_links_enabled,
        path.robot_color if path.color_enabled else None,
    )
    return Playback(
        look,
        path.state_display_time,
        path.use_sim_time,
        path.loop_animation,
        path.interrupt_display,
        path.show_trail,
        path.trail_step_size,
        path.position if path.paused else None,
        attached,
        f"{above}state_display_time",
    )


class PathView(msgspec.Struct):
    """The path that a display shows.

    Args:
        robots: draw the robot.
        player: says at which point it is.
    """

    robots: Robots
    player: PathPlayer = msgspec.field(default_factory=PathPlayer)
    attached: HeldObjects = msgspec.field(default_factory=HeldObjects)
    _trail: PathTrail = msgspec.field(default_factory=PathTrail)
    _path_cache: tuple[Any, Poser, JointPath] | None = None

    @property
    def newest(self) -> JointPath | None:
        """The newest path."""
        return self._path_cache and self._path_cache[2]

    def take(self, message: Any, playback: Playback) -> None:
        """Take the newest message, None before the first."""
        model = self.robots.model
        if message is None or model is None:
            self._path_cache = None
        elif self._path_cache is None or self._path_cache[:2] != (message, model.poser):
            self._path_cache = message, model.poser, path_of(message, model.poser)
        self.player.take(self.newest, playback.interrupts)

    def advance(self, playback: Playback, now_ns: int) -> object:
        """Go on to this time; the result changes with what is to be drawn."""
        clock_s = now_ns / SECOND if playback.by_shown_time else time.monotonic()
        self.player.step(clock_s, speed_of(playback.speed) or Speed(), playback.loops)
        if playback.share is not None:
            self.player.hold(playback.share)
        return self.player.index, self.player.path, self.player.is_moving

    def draw(
        self, playback: Playback, frame: str, ctx: Context, scene: KnownScene | None = None
    ) -> None:
        """Draw the robot at the current point, and the trail.

        Args:
            playback: how.
            frame: that places the robot if the path does not say it.
            ctx: receives nodes and statuses.
            scene: at that point, with what the robot holds; None if that follows from the path.
        """
        model, path = self.robots.model, self.player.path
        self.robots.report(playback.look, ctx)
        if speed_of(playback.speed) is None:
            ctx.warn(
                "Speed",
                f"State Display Time {named(playback.speed)} is invalid. Write a factor such as "
                f"3x or a time such as 0.05s. {DEFAULT_SPEED} is used.",
                Remedy(playback.speed_path, DEFAULT_SPEED, f"Use {DEFAULT_SPEED}"),
            )
        if model is None or path is None:
            return
        newest = self.newest or path
        if not len(path):
            ctx.warn("Path", "The path has no points. Plan again.")
            return
        self._report(path, newest, ctx)
        index, frame = self.player.index, path.frame or frame
        poses = model.poser.place(path.values[index], path.poses[index])
        self.robots.draw(poses, playback.look, frame, PREFIX, ctx)
        rgba = with_alpha(playback.attached, playback.look.alpha)
        scene = scene or KnownScene(attached=path.attached or {})
        if playback.look.visual or playback.look.collision:
            self.attached.draw(scene, poses, rgba, frame, PREFIX, ctx)
        if playback.trail:
            step = max(playback.step, -(-len(path) // MAX_STATES))
            if step > playback.step:
                ctx.warn("Trail", f"Only every {step}th point is drawn: there are {len(path)}.")
            last = index if self.player.is_moving else len(path) - 1
            self._trail.draw(self.robots, path, step, last, playback.look, frame, ctx)

    def inspect(self, hit: Hit, ctx: Context) -> Details | None:
        """Return a link, with the point of the path; or what the robot holds."""
        path = self.player.path
        details = self.attached.inspect(hit) or self._trail.inspect(hit)
        details = details or self.robots.inspect(hit, ctx.frames)
        if details is None or path is None or not hit.key.startswith(PREFIX):
            return details
        point: Mapping[str, object] = {"Point": _point(path, self.player.index)}
        return replace(details, values={**point, **details.values})

    def _report(self, path: JointPath, newest: JointPath, ctx: Context) -> None:
        ctx.ok("Path", f"{_point(path, self.player.index)}.")
        model = self.robots.model
        if newest.unknown_joints:
            names = listed([named(name) for name in newest.unknown_joints], NAMED)
            ctx.warn(
                "Joints",
                f"The robot has no joint {names}. Check that its URDF is that of the path.",
            )
        elif newest.model and model is not None and newest.model != model.robot.name:
            ctx.warn(
                "Joints",
                f"The path is for the robot {named(newest.model)}, the URDF describes "
                f"{named(model.robot.name)}.",
            )
        if newest.faults:
            ctx.warn("Points", joined(*newest.faults[:NAMED]))


def _point(path: JointPath, index: int) -> str:
    return f"Point {index + 1} of {counted(len(path), 'point')}, at {path.times[index]:.2f} s"
