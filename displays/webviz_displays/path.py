"""The Path display."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray

from webviz import (
    Color,
    Comparable,
    Context,
    Details,
    Display,
    Group,
    Hit,
    Input,
    Keep,
    Pose,
    Prop,
    Sample,
    Topic,
)
from webviz.api.consistency import RobotPath
from webviz.data import messages
from webviz.data.rotations import matrices, normalized, w_first
from webviz.data.words import counted
from webviz_displays.point_cloud2.decimation import Rows, evenly
from webviz_displays.shared.colors import Alpha
from webviz_displays.shared.geometry import Metres, along_x, is_drawable, origin_near, transformed
from webviz_displays.shared.properties import opaque

F64 = NDArray[np.float64]

MAX_POSES = 100_000
"""Poses drawn per path; they take up to 50 ms of the frame loop."""


class Path(Display, Comparable):
    """The line a planner wants a robot to follow, and its poses."""

    rviz = "rviz_default_plugins/Path"
    icon = "path"

    topic: Annotated[
        Topic, Input("nav_msgs/msg/Path", is_sporadic=True), Prop(help="Topic of the paths.")
    ] = Topic("/path")
    line_style: Annotated[
        Literal["Lines", "Billboards"],
        Prop(help="Lines are one pixel wide, Billboards have a width in metres."),
    ] = "Lines"
    line_width: Annotated[
        float,
        Prop(ge=0.001, unit="m", when=("line_style", "Billboards"), help="Width of the line."),
    ] = 0.03
    color: Annotated[Color, Prop(help="Colour of the line.")] = (25, 255, 0)
    alpha: Annotated[Alpha, Prop(help="Opacity of the line.")] = 1.0
    buffer_length: Annotated[int, Prop(ge=1, help="How many of the newest paths to show.")] = 1
    offset: Annotated[
        tuple[float, float, float],
        Prop(unit="m", help="Offset of the drawn path, in the fixed frame."),
    ] = (0.0, 0.0, 0.0)
    pose_style: Annotated[
        Literal["None", "Axes", "Arrows"], Prop(help="How to draw each pose of the path.")
    ] = "None"
    length: Annotated[Metres, Prop(when=("pose_style", "Axes"), help="Length of the axes.")] = 0.3
    radius: Annotated[
        Metres, Prop(when=("pose_style", "Axes"), rviz_factor=2.0, help="Radius of the axes.")
    ] = 0.03
    pose_color: Annotated[
        Color, Prop(when=("pose_style", "Arrows"), help="Colour of the arrows.")
    ] = (255, 85, 255)
    shaft_length: Annotated[
        float,
        Prop(ge=0, unit="m", when=("pose_style", "Arrows"), help="Length of the arrows' shafts."),
    ] = 0.1
    head_length: Annotated[
        Metres, Prop(when=("pose_style", "Arrows"), help="Length of the arrows' heads.")
    ] = 0.2
    shaft_diameter: Annotated[
        Metres, Prop(when=("pose_style", "Arrows"), help="Diameter of the shafts.")
    ] = 0.1
    head_diameter: Annotated[
        Metres, Prop(when=("pose_style", "Arrows"), help="Diameter of the heads.")
    ] = 0.3

    def history(self) -> Keep:
        """Return the newest paths."""
        return Keep(count=self.buffer_length)

    def draw(self, sample: Sample, ctx: Context) -> None:
        """One path, in the frame and at the stamp of its header."""
        path: messages.Path = sample.message
        count = len(path.poses)
        if not count:
            ctx.warn("Path", "The path is empty. Check the planner's log.")
            return
        bad = ~is_drawable(path.poses.positions)
        bad |= ~np.isfinite(path.poses.orientations).all(axis=1)
        if bad.any():
            index = int(np.flatnonzero(bad)[0])
            more = f", as {bad.sum() - 1} more" if bad.sum() > 1 else ""
            ctx.error("Path", f"{_fault(path, index)}{more}: the path is not drawn.")
            return
        ctx.ok("Path", f"Showing {counted(count, 'pose')}.")
        positions, orientations = path.poses.positions, path.poses.orientations
        rows = None
        if count > MAX_POSES:
            ctx.warn("Path", f"Showing {MAX_POSES} of {count} poses, evenly picked.")
            rows = evenly(count, MAX_POSES)
            positions, orientations = positions[rows], orientations[rows]
        if count == 1 and self.pose_style == "None":
            ctx.warn("Path", "The path has only one pose; a line needs two.")

        # Offset is in the fixed frame; the group turns with the frame of the path.
        origin = origin_near(positions)
        corner = transformed(sample.pose, [origin])[0] + self.offset
        group = ctx.follow(None, offset=Pose(tuple(corner.tolist()), sample.pose.wxyz))
        xyz = positions - origin
        if self.alpha == 0:
            ctx.warn(
                "Path", "The line is invisible: alpha is 0. Increase it to show the line.", opaque()
            )
        else:
            width, unit = (1.0, "px") if self.line_style == "Lines" else (self.line_width, "m")
            ids = None if rows is None else rows[:-1]
            group.strip("line", xyz, self.color, width, unit, ids, self.alpha)
        if self.pose_style != "None":
            self._draw_poses(xyz, orientations, rows, group, ctx)

    def consistency_input(self, samples: Sequence[Sample], ctx: Context) -> RobotPath | None:
        """Return the newest path."""
        if not samples:
            return None
        sample = samples[-1]
        xyz = sample.message.poses.positions
        if len(xyz) < 2 or not is_drawable(xyz).all():
            return None
        return RobotPath(sample.frame, sample.received_ns, xyz)

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        """Return a pose, or the one that a piece of the line begins at."""
        path: messages.Path = hit.sample.message
        pose = path.poses[hit.id]
        (wxyz,), _ = normalized(w_first([path.poses.orientations[hit.id]]))
        placed = Pose(tuple(path.poses.positions[hit.id].tolist()), tuple(wxyz.tolist()))
        values: dict[str, object] = {"Poses in the path": len(path.poses)}
        if stamp_ns := pose.header.stamp_ns:
            values["Stamp of the pose"] = f"{stamp_ns / 1e9:.6f} s"
        frame = pose.header.frame_id or path.header.frame_id
        return Details(f"Pose {hit.id}", {**values, f"Pose in {frame}": placed})

    def _draw_poses(
        self, xyz: F64, xyzw: F64, rows: Rows | None, group: Group, ctx: Context
    ) -> None:
        wxyz, ok = normalized(w_first(xyzw))
        if not ok.all():
            ctx.warn(
                "Orientation",
                f"The orientation of {(~ok).sum()} of {len(ok)} poses is all zeros; "
                "they are drawn without rotation. Fix the planner.",
            )
        if self.pose_style == "Axes":
            group.axes("poses", xyz, wxyz, self.length, self.radius, rows)
        else:
            segments = along_x(xyz, matrices(wxyz), self.shaft_length + self.head_length)
            radii = self.shaft_diameter / 2, self.head_diameter / 2
            group.arrows("poses", segments, self.pose_color, *radii, self.head_length, rows)


def _fault(path: messages.Path, index: int) -> str:
    """Return a description of an invalid pose."""
    x, y, z = path.poses.positions[index].tolist()
    qx, qy, qz, qw = path.poses.orientations[index].tolist()
    return (
        f"Pose {index} of {len(path.poses)} has position ({x:g}, {y:g}, {z:g}) and orientation "
        f"({qx:g}, {qy:g}, {qz:g}, {qw:g})"
    )
