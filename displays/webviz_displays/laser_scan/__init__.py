"""The LaserScan display."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray

from webviz import (
    Comparable,
    Context,
    Details,
    Hit,
    Input,
    Pose,
    Prop,
    Quantity,
    Rgb,
    Sample,
    Sweep,
    Topic,
)
from webviz.api.consistency import ScanPoints
from webviz.data import messages
from webviz_displays.laser_scan import beams
from webviz_displays.shared.geometry import coordinate
from webviz_displays.shared.points_display import PointsDisplay
from webviz_displays.shared.properties import opaque

__all__ = ["LaserScan"]

Floats = NDArray[np.floating[Any]]
U8 = NDArray[np.uint8]

LONG_SCAN_S = 1.0
"""A scan that takes longer is probably a wrong time_increment (RViz's limit)."""

_LONGEST_WAIT_NS = 9e9
"""Transforms are kept for 10 s: those of the first beam of a longer scan are gone at its end."""

_ENDLESS_SCAN_S = 3600.0
"""A longer duration is not a valid scan, and its stamps may overflow."""


class LaserScan(PointsDisplay, Comparable, Sweep):
    """Points where a planar laser scanner hit something."""

    rviz = "rviz_default_plugins/LaserScan"
    icon = "laser"

    topic: Annotated[
        Topic, Input("sensor_msgs/msg/LaserScan"), Prop(help="Topic of the scans.")
    ] = Topic("/scan")
    color_transformer: Annotated[
        Literal["Intensity", "AxisColor", "FlatColor"], Prop(help="How points are coloured.")
    ] = "Intensity"
    channel_name: Annotated[
        Literal["intensity", "range", "x", "y", "z"],
        Prop(
            when=("color_transformer", "Intensity"),
            help="Value that determines the colour; x, y and z are in the fixed frame.",
        ),
    ] = "intensity"
    deskew: Annotated[
        Literal["De-skewed", "As measured"],
        Prop(
            rviz="De-skew",
            help="Place each beam by the laser's pose at its own time, or all beams at the stamp.",
        ),
    ] = "De-skewed"

    def duration_ns(self, message: messages.LaserScan) -> int:
        """De-skewing needs transforms up to the last beam."""
        duration_ns = (len(message.ranges) - 1) * (message.time_increment * 1e9)
        if self.deskew == "As measured" or not 0 < duration_ns <= _LONGEST_WAIT_NS:
            return 0
        return round(duration_ns)

    def draw(self, sample: Sample, ctx: Context) -> None:
        """One scan, in the frame of the laser at the stamp."""
        scan: messages.LaserScan = sample.message
        if problem := beams.fault(scan):
            ctx.error("Points", problem)
            return
        points = beams.project(scan)
        say = ctx.ok if len(points.beams) else ctx.warn
        say("Points", points.sentence())
        if self.alpha == 0:
            ctx.warn("Points", f"Invisible: alpha is 0. {points.sentence()}", opaque())
            return
        if scan.angle_increment == 0 and points.total > 1:
            ctx.warn(
                "Angles",
                "angle_increment is 0, so all beams lie on one line. Set it in the laser driver.",
            )
        xyz = self._place(points, sample, ctx)
        colors = self._colors(scan, points, xyz, sample, ctx)
        # RViz draws scans in the fixed frame, so the sides of boxes lie along its axes.
        w, x, y, z = sample.pose.wxyz
        turn = w, -x, -y, -z
        self.draw_points(xyz, colors, ctx, ctx, turn, ids=points.beams)

    def consistency_input(self, samples: Sequence[Sample], ctx: Context) -> ScanPoints | None:
        """Return the points of the newest scan."""
        if not samples or beams.fault(samples[-1].message):
            return None
        sample = samples[-1]
        xyz = self._place(beams.project(sample.message), sample, ctx).astype(np.float64)
        return ScanPoints(sample.frame, sample.stamp_ns, xyz)

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        """Return a beam: its range, intensity and angle."""
        scan: messages.LaserScan = hit.sample.message
        values: dict[str, object] = {"Range": Quantity(np.float32(scan.ranges[hit.id]), "m")}
        if len(scan.intensities) == len(scan.ranges):
            values["Intensity"] = scan.intensities[hit.id]
        angle = scan.angle_min + hit.id * scan.angle_increment
        values["Angle"] = f"{angle:.6f} rad, {math.degrees(angle):.2f}°"
        if scan.time_increment:
            time_ms = round(1e3 * hit.id * scan.time_increment, 3)
            values["Time after the first beam"] = Quantity(time_ms, "ms")
        return Details(f"Beam {hit.id}", values | {"Beams in the scan": len(scan.ranges)})

    def _place(self, points: beams.BeamPoints, sample: Sample, ctx: Context) -> Floats:
        """Return the points in the frame of the laser at the stamp."""
        scan: messages.LaserScan = sample.message
        duration = (points.total - 1) * scan.time_increment
        if not abs(duration) < _ENDLESS_SCAN_S:
            ctx.warn(
                "Scan Time",
                f"time_increment is {scan.time_increment}; using 0. Fix it in the laser driver.",
            )
            return points.xyz
        if duration > LONG_SCAN_S:
            ctx.warn(
                "Scan Time",
                f"The scan takes {duration:.3g} s by its time_increment of "
                f"{scan.time_increment:g} s. Check that the driver gives it in seconds.",
            )
        if self.deskew == "As measured" or not duration or not sample.stamp_ns:
            return points.xyz
        xyz, missing = beams.deskew(points, sample, ctx.frames)
        if missing:
            ctx.warn(
                "De-skew",
                f"{missing} of {len(xyz)} beams have no transform at their time; "
                "the transform of the nearest beam that has one is used.",
            )
        return xyz

    def _colors(
        self,
        scan: messages.LaserScan,
        points: beams.BeamPoints,
        xyz: Floats,
        sample: Sample,
        ctx: Context,
    ) -> U8 | Rgb:
        """Return a colour for each point (N, 3), or one for all."""
        if self.color_transformer == "FlatColor":
            return self.color
        if self.color_transformer == "AxisColor":
            return self.axis_colors(xyz, Pose(), sample.pose, ctx)
        return self.intensity_colors(self._channel(scan, points, xyz, sample, ctx), ctx)

    def _channel(
        self,
        scan: messages.LaserScan,
        points: beams.BeamPoints,
        xyz: Floats,
        sample: Sample,
        ctx: Context,
    ) -> Floats:
        """Return the values (N,) that determine the colour."""
        if self.channel_name in ("x", "y", "z"):
            values, origin = coordinate(sample.pose, xyz, "xyz".index(self.channel_name))
            return values + origin
        if self.channel_name == "intensity":
            count = len(scan.intensities)
            if count == points.total:
                return scan.intensities.take(points.beams)
            if count:
                ctx.warn(
                    "Intensity",
                    f"The scan has {count} intensities for {points.total} ranges; "
                    "colouring by range.",
                )
            else:
                ctx.ok("Intensity", "The scan has no intensities; colouring by range.")
        return scan.ranges.take(points.beams)
