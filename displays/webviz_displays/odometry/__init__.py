"""The Odometry display."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from math import dist
from typing import Annotated, NamedTuple

import msgspec
import numpy as np
from msgspec.structs import replace

from webviz import (
    Context,
    Details,
    Display,
    Hit,
    Input,
    Keep,
    Lookback,
    Pose,
    Prop,
    Sample,
    Selective,
    Topic,
)
from webviz.data import messages
from webviz.data.rotations import angle_between
from webviz.data.words import counted
from webviz_displays.odometry.covariance import LARGEST
from webviz_displays.odometry.covariance_marks import draw_covariances
from webviz_displays.odometry.details import odometry_details
from webviz_displays.shared import pose_history
from webviz_displays.shared.geometry import origin_near
from webviz_displays.shared.pose_history import UNIT_TOLERANCE, GrowingTrail
from webviz_displays.shared.pose_marks import draw_poses
from webviz_displays.shared.pose_properties import Covariance, PoseShape

__all__ = ["Odometry"]

MAX_READ = 3000
"""Messages that are read: one to two minutes. Of a robot that rests for longer, the trail begins
there after a seek."""
FIRST_READ = 250
MAX_CANDIDATES = 60
"""Largest number of candidates. Of a robot at rest, every message may be the first of a trail: it
is skipped."""


def fault(message: messages.Odometry) -> str:
    """Return a sentence why a pose cannot be drawn, "" if it can."""
    if problem := pose_history.fault(message.pose.pose):
        return problem
    q = message.pose.pose.orientation
    square = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w
    if square == 0.0:
        return "The orientation is all zeros. The publisher must set it (w = 1 for no rotation)."
    if abs(square - 1.0) >= UNIT_TOLERANCE:
        return (
            f"The orientation ({q.x:g}, {q.y:g}, {q.z:g}, {q.w:g}) is not normalised: "
            f"its squared length is {square:g} instead of 1."
        )
    return ""


class TrailPlace(NamedTuple):
    """A pose, as far as it decides on the poses that are kept after it.

    Args:
        position: metres.
        wxyz: quaternion.
        is_sound: whether the covariance is, where covariances are shown.
    """

    position: tuple[float, float, float]
    wxyz: tuple[float, float, float, float]
    is_sound: bool


def place_of(message: messages.Odometry, *, with_covariance: bool) -> TrailPlace:
    """Return the place of a pose."""
    p, q = message.pose.pose.position, message.pose.pose.orientation
    is_known_sound = not with_covariance or is_sound(message)
    return TrailPlace((p.x, p.y, p.z), (q.w, q.x, q.y, q.z), is_known_sound)


def has_moved(new: TrailPlace, last: TrailPlace, distance: float, angle: float) -> bool:
    """Return whether a pose is at least this far (m) or turned this much (rad) from the last."""
    if dist(new.position, last.position) >= distance:
        return True
    return angle_between(new.wxyz, last.wxyz) >= angle


def is_sound(message: messages.Odometry) -> bool:
    """Return whether the covariance of a pose is finite, of a sensible size, nowhere negative."""
    entries = message.pose.covariance
    return bool(np.abs(entries).max() <= LARGEST and entries[::7].min() >= 0)


class TrailRule(msgspec.Struct, frozen=True):
    """The poses that are kept.

    Args:
        distance: metres from the last one.
        angle: radians from the last one.
        with_covariance: whether a pose is kept also if its covariance becomes invalid, or valid.
    """

    distance: float
    angle: float
    with_covariance: bool

    def place_of(self, message: messages.Odometry) -> TrailPlace:
        """Return the place of a pose."""
        return place_of(message, with_covariance=self.with_covariance)

    def keeps(self, new: TrailPlace, last: TrailPlace) -> bool:
        """Return whether a pose is kept after the last one."""
        return new.is_sound != last.is_sound or has_moved(new, last, self.distance, self.angle)

    def is_far(self, new: TrailPlace, other: TrailPlace) -> bool:
        """Return whether a pose is kept after all that are not kept after the other one."""
        return has_moved(new, other, 2 * self.distance, 2 * self.angle)


def kept_poses(
    newest_first: Iterator[messages.Odometry], keep: int, rule: TrailRule
) -> Sequence[int]:
    """Return the past messages that are the poses of the trail.

    Args:
        newest_first: past messages.
        keep: number of newest poses; 0 is unlimited.
        rule: of the trail.

    Returns:
        Their numbers, 0 for the newest message, at least as many as there are to keep. Of older
        messages, which trails may not have in common, all: the first without a transform is none
        of the trail.
    """
    places: list[TrailPlace | None] = []
    for size in _sizes():
        for message in itertools.islice(newest_first, size - len(places)):
            places.append(None if fault(message) else rule.place_of(message))
        met = _met(places, rule) or 0
        numbers = _selection(places[:met], rule)
        if 0 < keep <= len(numbers):
            return numbers
        if len(places) < size:
            return [*range(len(places) - 1, met - 1, -1), *numbers]
    return _selection(places, rule)


def _sizes() -> Iterator[int]:
    size = FIRST_READ
    while size < MAX_READ:
        yield size
        size *= 2
    yield MAX_READ


def _met(newest_first: Sequence[TrailPlace | None], rule: TrailRule) -> int | None:
    """Return the number of newest places that every trail has, None if there are none."""
    first: TrailPlace | None = None
    is_older_possible = True
    """True while the last place that was kept may be one before the first."""
    candidates: list[tuple[int, TrailPlace]] = []
    """Candidates that may be the last one that was kept."""
    for number, place in _oldest_first(newest_first):
        if first is None:
            first = place
        elif rule.is_far(place, first):
            is_older_possible = False
        staying = [each for each in candidates if not rule.keeps(place, each[1])]
        if is_older_possible or len(staying) < len(candidates):
            staying.append((number, place))
        candidates = staying
        if len(candidates) == 1 and not is_older_possible:
            return candidates[0][0] + 1
        if len(candidates) > MAX_CANDIDATES:
            first, is_older_possible, candidates = None, True, []
    return None


def _selection(newest_first: Sequence[TrailPlace | None], rule: TrailRule) -> Sequence[int]:
    """Return the numbers of the places of the trail that begins with the oldest."""
    last: TrailPlace | None = None
    numbers: list[int] = []
    for number, place in _oldest_first(newest_first):
        if last is None or rule.keeps(place, last):
            last = place
            numbers.append(number)
    return numbers


def _oldest_first(places: Sequence[TrailPlace | None]) -> Iterator[tuple[int, TrailPlace]]:
    for number in range(len(places) - 1, -1, -1):
        if (place := places[number]) is not None:
            yield number, place


class Odometry(Display, Selective):
    """Estimated poses of a robot, past and present, with their uncertainty."""

    rviz = "rviz_default_plugins/Odometry"
    icon = "odometry"

    topic: Annotated[Topic, Input("nav_msgs/msg/Odometry"), Prop(help="Topic of the odometry.")] = (
        Topic("/odom")
    )
    position_tolerance: Annotated[
        float, Prop(ge=0, unit="m", help="Add a pose after the robot moved by this distance.")
    ] = 0.1
    angle_tolerance: Annotated[
        float, Prop(ge=0, unit="rad", help="Add a pose after the robot turned by this angle.")
    ] = 0.1
    keep: Annotated[int, Prop(ge=0, help="Number of newest poses to keep; 0 keeps all.")] = 100
    shape: Annotated[PoseShape, Prop(help="How to draw each pose.")] = PoseShape()
    covariance: Annotated[Covariance, Prop(help="How to draw the covariances.")] = Covariance()

    def new_state(self) -> GrowingTrail:
        """No poses."""
        return GrowingTrail(lambda message: message.pose.pose)

    def history(self) -> Keep:
        """Return the newest poses that were accepted."""
        return Keep(count=self.keep)

    def lookback(self, name: str) -> Lookback:
        """Return the poses that are kept, as far as they do not take too many messages to find."""
        return Lookback(chooses=lambda past: kept_poses(past, self.keep, self.rule()))

    def rule(self) -> TrailRule:
        """Return the rule by which poses are kept."""
        return TrailRule(self.position_tolerance, self.angle_tolerance, self.covariance.value)

    def accept(self, new: Sample, buffered: Sequence[Sample]) -> bool | str:
        """Return whether the robot moved by one of the tolerances, or why the pose is invalid.

        A robot at rest counts as well when its covariance becomes invalid, or valid again.
        """
        if problem := fault(new.message):
            return problem
        rule = self.rule()
        return not buffered or rule.keeps(
            rule.place_of(new.message), rule.place_of(buffered[-1].message)
        )

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """All poses as one node, and their covariances as a few more."""
        if not samples:
            return
        ctx.ok("Pose", f"Showing {counted(len(samples), 'pose')}.")
        poses = ctx.state.of(samples)
        origin = origin_near(poses.positions)
        group = ctx.follow(None, offset=Pose(origin))
        poses = replace(poses, positions=poses.positions - origin)
        draw_poses(self.shape, poses, group, ctx, path="shape.alpha")
        draw_covariances(self.covariance, samples, poses, group, ctx, np.arange(len(samples)))

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        """Return a message; the wedges are one mesh, which does not know of its messages."""
        if hit.id is None:
            return Details("Covariances of yaw")
        return odometry_details(hit.samples[hit.id])
