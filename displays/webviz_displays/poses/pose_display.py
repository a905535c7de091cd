"""Base of the displays of single poses, with RViz's properties."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Literal

import numpy as np
from msgspec.structs import replace

from webviz import Color, Context, Details, Display, Group, Hit, Pose, Prop, Sample, Topic
from webviz.api.nodes import Ids
from webviz.data import messages
from webviz.data.rotations import normalized
from webviz.data.words import counted, joined
from webviz_displays.shared.colors import Alpha
from webviz_displays.shared.geometry import LONGEST, Length, origin_near
from webviz_displays.shared.pose_history import GrowingTrail, PoseOf, PoseTrail, fault
from webviz_displays.shared.pose_marks import draw_poses, report_orientations
from webviz_displays.shared.pose_properties import PoseShape
from webviz_displays.shared.properties import HistoryLength

BY_ARROW = ("shape", "Arrow")
BY_AXES = ("shape", "Axes")


class PoseDisplay(Display):
    """Base of displays that draw the pose of each message."""

    topic: Annotated[Topic, Prop(help="Topic of the poses.")] = Topic()
    shape: Annotated[
        Literal["Arrow", "Axes"], Prop(help="Draw an arrow along x, or all three axes.")
    ] = "Arrow"
    color: Annotated[Color, Prop(when=BY_ARROW, help="Colour of the arrow.")] = (255, 25, 0)
    alpha: Annotated[Alpha, Prop(when=BY_ARROW, help="Opacity of the arrow; 0 is invisible.")] = 1.0
    shaft_length: Annotated[
        float, Prop(ge=0, le=LONGEST, unit="m", when=BY_ARROW, help="Length of the shaft.")
    ] = 1.0
    shaft_radius: Annotated[
        Length, Prop(when=BY_ARROW, rviz_factor=2.0, help="Radius of the shaft.")
    ] = 0.05
    head_length: Annotated[Length, Prop(when=BY_ARROW, help="Length of the head.")] = 0.3
    head_radius: Annotated[
        Length, Prop(when=BY_ARROW, rviz_factor=2.0, help="Radius of the head.")
    ] = 0.1
    axes_length: Annotated[Length, Prop(when=BY_AXES, help="Length of each axis.")] = 1.0
    axes_radius: Annotated[
        Length, Prop(when=BY_AXES, rviz_factor=2.0, help="Radius of each axis.")
    ] = 0.1
    history_length: HistoryLength = 1

    def new_state(self) -> GrowingTrail:
        """No poses."""
        return GrowingTrail(self.pose_of())

    def pose_of(self) -> PoseOf:
        """Return the function that reads the pose of a message."""
        raise NotImplementedError

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """All poses as one node, each in the frame and at the stamp of its header."""
        if not samples:
            return
        every: PoseTrail = ctx.state.of(samples)
        ids = np.flatnonzero(every.ok)
        if len(ids):
            ctx.ok("Pose", f"Showing {counted(len(ids), 'pose')}.")
            poses = every[ids]
            origin = origin_near(poses.positions)
            group = ctx.follow(None, offset=Pose(origin))
            poses = replace(poses, positions=poses.positions - origin)
            draw_poses(self._look(), poses, group, ctx, ids)
            report_orientations(poses.squares, "pose", ctx)
            self.draw_more([samples[i] for i in ids.tolist()], poses, group, ctx, ids)
        if not every.ok[-1]:
            ctx.error(
                "Pose", joined(fault(self.pose_of()(samples[-1].message)), "Fix the publisher.")
            )

    def draw_more(
        self, samples: Sequence[Sample], poses: PoseTrail, group: Group, ctx: Context, ids: Ids
    ) -> None:
        """Draw what else the messages say about their poses.

        Args:
            samples: whose poses are drawn.
            poses: of them, in the coordinates of the group.
            group: where to draw.
            ctx: collects statuses.
            ids: of the samples.
        """

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        """Return the pose in its own frame."""
        sample = hit.samples[hit.id]
        return Details(
            f"Pose {sample.number}",
            {f"Pose in {sample.frame}": placed(self.pose_of()(sample.message))},
        )

    def _look(self) -> PoseShape:
        _, *names = PoseShape.__struct_fields__
        return PoseShape(value=self.shape, **{name: getattr(self, name) for name in names})


def placed(pose: messages.Pose) -> Pose:
    """Return a pose of a message with a unit quaternion."""
    p, q = pose.position, pose.orientation
    (wxyz,), _ = normalized([(q.w, q.x, q.y, q.z)])
    return Pose((p.x, p.y, p.z), tuple(wxyz.tolist()))
