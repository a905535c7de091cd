"""Many poses of one message: which of them to draw, and as what."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz import Color, Context, Details, Group, Hit, Pose, Prop, Rgb, Sample
from webviz.data import messages
from webviz.data.rotations import matrices, normalized, w_first
from webviz.data.words import counted
from webviz_displays.point_cloud2.decimation import evenly
from webviz_displays.poses.pose_display import placed
from webviz_displays.shared.colors import Alpha
from webviz_displays.shared.geometry import along_x, is_drawable, origin_near, transformed
from webviz_displays.shared.pose_marks import report_orientations
from webviz_displays.shared.properties import opaque
from webviz_displays.shared.rods import add_solid_arrows, rods

F64 = NDArray[np.float64]
Ids = NDArray[np.intp]

Shape = Annotated[
    Literal["Arrow (Flat)", "Arrow (3D)", "Axes"],
    Prop(help="Draw arrows of lines along x, solid ones, or all three axes."),
]
"""A property: as what the poses are drawn."""
_BY_ARROWS = ("shape", ("Arrow (Flat)", "Arrow (3D)"))
ArrowColor = Annotated[Color, Prop(when=_BY_ARROWS, help="Colour of the arrows.")]
ArrowAlpha = Annotated[
    Alpha,
    Prop(
        when=_BY_ARROWS,
        help="Opacity of the arrows.",
    ),
]

MAX_POSES = 50_000
"""Poses drawn per message; browsers draw three lines or two solids for each."""

_WINGS = np.array(((0.0, 0.0), (1.0, 0.0), (0.75, 0.2), (0.75, -0.2)))
"""Tail, tip and the ends of the head of RViz's flat arrow, as shares of its length."""

_AXES = np.array(((255, 0, 0), (0, 255, 0), (0, 0, 255)), np.uint8)


class PoseSet(msgspec.Struct, frozen=True):
    """The poses of a message that are drawn.

    Args:
        xyz: (N, 3), metres, in the coordinates of `group`.
        wxyzs: (N, 4), unit quaternions.
        group: where to draw them.
        ids: (N,), their numbers in the message.
    """

    xyz: F64
    wxyzs: F64
    group: Group
    ids: Ids

    def draw_flat(self, lengths: float | F64, color: Rgb, alpha: float) -> None:
        """Arrows of three lines of one pixel, of one length in metres or of one each (N,)."""
        turns = matrices(self.wxyzs)
        x, y = (_WINGS * np.reshape(lengths, (-1, 1, 1))).transpose(2, 0, 1)[..., None]
        points = self.xyz[:, None] + x * turns[:, None, :, 0] + y * turns[:, None, :, 1]
        segments = points[:, [[0, 1], [1, 2], [1, 3]]].reshape(-1, 2, 3)
        self.group.lines(
            "poses", segments, color, ids=np.repeat(self.ids, len(_WINGS) - 1), opacity=alpha
        )

    def draw_arrows(
        self,
        lengths: float | F64,
        shaft_radius: float | F64,
        head_radius: float | F64,
        head_length: float | F64,
        color: Rgb,
        alpha: float,
    ) -> None:
        """Solid arrows; sizes in metres are one for all or one each (N,)."""
        span = np.broadcast_to(lengths, len(self.xyz))[:, None]
        segments = along_x(self.xyz, matrices(self.wxyzs), span)
        sizes = shaft_radius, head_radius, head_length
        add_solid_arrows(self.group, segments, color, *sizes, alpha, self.ids)

    def draw_axes(self, lengths: float | F64, radius: float | F64) -> None:
        """Axes; sizes in metres are one for all or one each (N,)."""
        if isinstance(lengths, float) and isinstance(radius, float):
            self.group.axes("poses", self.xyz, self.wxyzs, lengths, radius, self.ids)
            return
        span = np.broadcast_to(lengths, len(self.xyz))[:, None, None]
        tails = np.repeat(self.xyz, 3, axis=0)
        tips = tails + (span * np.swapaxes(matrices(self.wxyzs), 1, 2)).reshape(-1, 3)
        solids = rods(tails, tips, 2 * np.repeat(np.broadcast_to(radius, len(self.xyz)), 3))
        self.group.instances(
            "poses",
            "cylinder",
            *solids[:2],
            np.tile(_AXES, (len(self.xyz), 1)),
            solids.wxyzs,
            ids=np.repeat(self.ids, 3),
        )


def drawable_poses(
    positions: F64, orientations: F64, sample: Sample, ctx: Context, noun: str
) -> PoseSet | None:
    """Return the poses of a message that can be drawn, None if there are none; says so.

    Args:
        positions: (N, 3), metres, in the frame of the sample.
        orientations: (N, 4), xyzw as sent.
        sample: of the message.
        ctx: collects statuses.
        noun: what has a pose, such as "pose" or "particle".
    """
    total, key = len(positions), f"{noun.capitalize()}s"
    if not total:
        ctx.warn(key, f"The message has no {noun}s. Check its publisher.")
        return None
    ok = is_drawable(positions) & np.isfinite(orientations).all(axis=1)
    ids = np.flatnonzero(ok)
    if not len(ids):
        ctx.error(key, f"No {noun} is finite and nearer than 1e9 m. Fix the publisher.")
        return None
    ctx.ok(key, f"Showing {counted(total, noun)}.")
    if len(ids) < total:
        ctx.warn(
            key,
            f"{total - len(ids)} of {total} {noun}s are not finite or farther than 1e9 m and not "
            "drawn. Fix the publisher.",
        )
    if len(ids) > MAX_POSES:
        ctx.warn(key, f"Showing {MAX_POSES} of {total} {noun}s, evenly picked.")
        ids = ids[evenly(len(ids), MAX_POSES)]
    xyz = positions[ids]
    with np.errstate(over="ignore"):
        report_orientations(np.square(orientations[ids]).sum(axis=1), noun, ctx)
    wxyzs, _ = normalized(w_first(orientations[ids]))
    origin = origin_near(xyz)
    corner = tuple(transformed(sample.pose, [origin])[0].tolist())
    group = ctx.follow(None, offset=Pose(corner, sample.pose.wxyz)) if any(origin) else ctx
    return PoseSet(xyz - origin, wxyzs, group, ids)


def is_invisible(alpha: float, ctx: Context, noun: str) -> bool:
    """Return whether alpha hides everything; says so."""
    if alpha == 0:
        ctx.warn(
            f"{noun.capitalize()}s", "Invisible: alpha is 0. Increase it to show them.", opaque()
        )
    return alpha == 0


def pose_details(hit: Hit, noun: str, pose: messages.Pose, total: int) -> Details:
    """Return the details of a pose of a message."""
    values = {f"Pose in {hit.sample.frame}": placed(pose), f"{noun}s in the message": total}
    return Details(f"{noun} {hit.id}", values)
