"""Paths, trajectories, objects and poses of Autoware."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

import msgspec
import numpy as np

from webviz import (
    Color,
    Context,
    Details,
    Display,
    Hit,
    Input,
    Keep,
    Pose,
    Prop,
    Sample,
    Selective,
    Topic,
)
from webviz.data.words import counted
from webviz_displays.autoware.objects import DetectedObjects, PredictedObjects, TrackedObjects
from webviz_displays.autoware.path import AutowarePath, AutowareTrajectory
from webviz_displays.shared.colors import Alpha
from webviz_displays.shared.geometry import LONGEST, origin_near
from webviz_displays.shared.pose_history import GrowingTrail, fault
from webviz_displays.shared.properties import opaque

__all__ = [
    "AutowarePath",
    "AutowareTrajectory",
    "DetectedObjects",
    "PoseHistory",
    "PredictedObjects",
    "TrackedObjects",
]


class LineView(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Appearance of the line."""

    value: Annotated[bool, Prop(help="Draw the line.")] = True
    width: Annotated[
        float, Prop(ge=0, le=LONGEST, unit="m", when=("value", True), help="Width of the line.")
    ] = 0.1
    alpha: Annotated[Alpha, Prop(when=("value", True), help="Opacity of the line.")] = 1.0
    color: Annotated[Color, Prop(when=("value", True), help="Colour of the line.")] = (
        255,
        255,
        255,
    )


class _State(msgspec.Struct):
    """The poses so far."""

    trail: GrowingTrail = msgspec.field(
        default_factory=lambda: GrowingTrail(lambda message: message.pose)
    )


class PoseHistory(Display, Selective):
    """The way along the newest poses of a topic, such as those of a localization."""

    rviz = "rviz_plugins::PoseHistory"

    topic: Annotated[
        Topic, Input("geometry_msgs/msg/PoseStamped"), Prop(help="Topic of the poses.")
    ] = Topic("/localization/pose_estimator/pose")
    buffer_size: Annotated[int, Prop(ge=1, le=16_000, help="How many poses to show.")] = 100
    line: Annotated[LineView, Prop(help="How to draw the line.")] = LineView()

    def new_state(self) -> _State:
        """No pose."""
        return _State()

    def history(self) -> Keep:
        """Return the newest poses."""
        return Keep(count=self.buffer_size)

    def accept(self, new: Sample, buffered: Sequence[Sample]) -> bool | str:
        """Poses that can be drawn."""
        return fault(new.message.pose) or True

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Draw a line through the poses, each where its frame was at its stamp."""
        if not samples:
            return
        state: _State = ctx.state
        trail = state.trail.of(samples)
        rows = np.flatnonzero(trail.ok)
        count = counted(len(rows), "pose")
        if len(rows) < 2:
            ctx.warn("Poses", f"{count}; a line needs two.")
        elif not self.line.value:
            ctx.warn("Poses", f"{count}; Line is switched off.")
        elif self.line.alpha == 0:
            text = "Invisible: alpha is 0. Increase it to show the line."
            ctx.warn("Poses", text, opaque("line.alpha"))
        else:
            ctx.ok("Poses", f"Showing {count}.")
            xyz = trail.positions[rows]
            near = origin_near(xyz)
            group = ctx.follow(None, offset=Pose(near))
            width, unit = (self.line.width, "m") if self.line.width else (1.0, "px")
            color, alpha = self.line.color, self.line.alpha
            group.strip("line", xyz - near, color, width, unit, rows[:-1], alpha)

    def inspect(self, hit: Hit, ctx: Context) -> Details | None:
        """Return the pose that a piece of the line begins at."""
        if hit.id >= len(hit.samples):
            return None
        sample = hit.samples[hit.id]
        return Details(f"Pose {hit.id}", {f"Pose in {sample.frame}": sample.message.pose})
