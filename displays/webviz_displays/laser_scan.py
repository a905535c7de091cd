"""The LaserScan display."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz import Color, Context, Display, Input, Keep, Prop, Sample, Topic, messages
from webviz_displays import beams
from webviz_displays.colors import bounds, faded, fractions, rainbow, ramp
from webviz_displays.geometry import conjugate, transformed

F64 = NDArray[np.float64]
U8 = NDArray[np.uint8]

LONG_SCAN_S = 1.0
"""A scan that takes longer is probably a wrong time_increment (RViz's limit)."""

_ENDLESS_SCAN_S = 3600.0
"""What takes longer is no scan, and its stamps may overflow."""

_SOLIDS: dict[str, Literal["box", "sphere"]] = {"Boxes": "box", "Spheres": "sphere"}

_AXES = ("X", "Y", "Z")
_LEAST_SPAN = 1e-3
"""Metres; a planar scan differs by rounding only, which is no reason for a rainbow."""


class ValueBounds(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Between which coordinates the rainbow of AxisColor lies."""

    value: Annotated[bool, Prop(help="Take the bounds from the points of each scan.")] = True
    min_value: Annotated[
        float, Prop(unit="m", when=("value", False), help="Coordinate that is drawn red.")
    ] = -10.0
    max_value: Annotated[
        float, Prop(unit="m", when=("value", False), help="Coordinate that is drawn magenta.")
    ] = 10.0


class LaserScan(Display):
    """Points where a planar laser scanner hit something."""

    rviz = "rviz_default_plugins/LaserScan"

    topic: Annotated[
        Topic, Input("sensor_msgs/msg/LaserScan"), Prop(help="Topic of the scans.")
    ] = Topic("/scan")
    style: Annotated[
        Literal["Points", "Squares", "Flat Squares", "Spheres", "Boxes", "Tiles"],
        Prop(help="Shape of each point; Squares and Tiles face the camera here."),
    ] = "Flat Squares"
    size: Annotated[
        float, Prop(gt=0, unit="m", rviz="Size (m)", help="Edge or diameter of each point.")
    ] = 0.01
    size_pixels: Annotated[
        float,
        Prop(
            ge=1,
            unit="px",
            rviz="Size (Pixels)",
            when=("style", "Points"),
            help="Diameter on the screen.",
        ),
    ] = 3.0
    alpha: Annotated[
        float,
        Prop(
            ge=0,
            le=1,
            widget="slider",
            help="Opacity of Spheres and Boxes; what is flat is opaque in the browser and fades "
            "towards dark grey.",
        ),
    ] = 1.0
    decay_time: Annotated[
        float, Prop(ge=0, unit="s", help="How long scans stay; 0 shows the newest only.")
    ] = 0.0
    deskew: Annotated[
        Literal["De-skewed", "As measured"],
        Prop(
            rviz="De-skew",
            help="Place each beam where the laser was at its time, or all at the stamp.",
        ),
    ] = "De-skewed"
    color_transformer: Annotated[
        Literal["Intensity", "AxisColor", "FlatColor"], Prop(help="What colours mean.")
    ] = "Intensity"
    channel_name: Annotated[
        Literal["intensity", "range", "x", "y", "z"],
        Prop(
            when=("color_transformer", "Intensity"),
            help="The number that is coloured; x, y and z are in the fixed frame.",
        ),
    ] = "intensity"
    use_rainbow: Annotated[
        bool,
        Prop(
            rviz="Use rainbow",
            when=("color_transformer", "Intensity"),
            help="Red is low and magenta high, instead of a ramp between two colours.",
        ),
    ] = True
    invert_rainbow: Annotated[
        bool, Prop(when=("use_rainbow", True), help="Magenta is low and red high.")
    ] = False
    min_color: Annotated[
        Color, Prop(when=("use_rainbow", False), help="Colour of the lowest value.")
    ] = (0, 0, 0)
    max_color: Annotated[
        Color, Prop(when=("use_rainbow", False), help="Colour of the highest value.")
    ] = (255, 255, 255)
    autocompute_intensity_bounds: Annotated[
        bool,
        Prop(
            when=("color_transformer", "Intensity"),
            help="Take the lowest and highest value from each scan.",
        ),
    ] = True
    min_intensity: Annotated[
        float,
        Prop(when=("autocompute_intensity_bounds", False), help="Value with the lowest colour."),
    ] = 0.0
    max_intensity: Annotated[
        float,
        Prop(when=("autocompute_intensity_bounds", False), help="Value with the highest colour."),
    ] = 4096.0
    color: Annotated[
        Color, Prop(when=("color_transformer", "FlatColor"), help="Colour of all points.")
    ] = (255, 255, 255)
    axis: Annotated[
        Literal["X", "Y", "Z"],
        Prop(when=("color_transformer", "AxisColor"), help="The coordinate that is coloured."),
    ] = "Z"
    autocompute_value_bounds: Annotated[
        ValueBounds,
        Prop(when=("color_transformer", "AxisColor"), help="Bounds of the coordinate."),
    ] = ValueBounds()
    use_fixed_frame: Annotated[
        bool,
        Prop(
            when=("color_transformer", "AxisColor"),
            help="Colour by coordinates in the fixed frame instead of the laser's.",
        ),
    ] = True

    def history(self) -> Keep:
        """Scans that came within the decay time, or the newest."""
        return Keep(count=0, seconds=self.decay_time) if self.decay_time else Keep()

    def duration_ns(self, message: messages.LaserScan) -> int:
        """De-skewing needs transforms up to the last beam."""
        duration = (len(message.ranges) - 1) * message.time_increment
        if self.deskew == "As measured" or not 0 < duration <= LONG_SCAN_S:
            return 0
        return round(duration * 1e9)

    def draw(self, sample: Sample, ctx: Context) -> None:
        """One scan, in the frame of the laser at the stamp."""
        scan: messages.LaserScan = sample.message
        if problem := beams.fault(scan):
            ctx.error("Points", problem)
            return
        hits = beams.project(scan)
        say = ctx.ok if len(hits.beams) else ctx.warn
        say("Points", hits.sentence())
        if self.alpha == 0:
            ctx.warn("Points", f"Invisible: alpha is 0. {hits.sentence()}")
            return
        if scan.angle_increment == 0 and hits.total > 1:
            ctx.warn("Angles", "angle_increment is 0: all beams lie on one line.")
        xyz = self._place(hits, sample, ctx)
        colors = self._colors(scan, hits, xyz, sample, ctx)
        if self.style in _SOLIDS:
            # As in RViz the sides of boxes lie along the axes of the fixed frame.
            upright = np.tile(conjugate(sample.pose.wxyz), (len(xyz), 1))
            shape, size = _SOLIDS[self.style], self.size
            ctx.instances("solids", shape, xyz, size, colors, upright, self.alpha)
            return
        colors = faded(colors, self.alpha)
        if self.style == "Points":
            dots = np.stack((xyz - _DOT / 2, xyz + _DOT / 2), axis=1)
            both_ends = np.repeat(colors[:, None], 2, axis=1)
            ctx.lines("points", dots, both_ends, self.size_pixels)
            return
        if self.style != "Flat Squares":
            ctx.ok("Style", f"{self.style} are drawn as flat squares that face the camera.")
        ctx.points("points", xyz, colors, self.size)

    def _place(self, hits: beams.Hits, sample: Sample, ctx: Context) -> F64:
        """The points in the frame of the laser at the stamp."""
        scan: messages.LaserScan = sample.message
        duration = (hits.total - 1) * scan.time_increment
        if not abs(duration) < _ENDLESS_SCAN_S:
            ctx.warn("Scan Time", f"time_increment is {scan.time_increment}; it is taken as 0.")
            return hits.xyz
        if duration > LONG_SCAN_S:
            ctx.warn(
                "Scan Time",
                f"The scan takes {duration:.3g} s by its time_increment of "
                f"{scan.time_increment:g} s, which is rather long: is it in seconds?",
            )
        if self.deskew == "As measured" or not duration or not sample.stamp_ns:
            return hits.xyz
        xyz, missing = beams.deskew(hits, sample, ctx.frames)
        if missing:
            ctx.warn(
                "De-skew",
                f"{missing} of {len(xyz)} beams have no transform at their time; "
                "they are drawn with that of the nearest beam which has.",
            )
        return xyz

    def _colors(
        self, scan: messages.LaserScan, hits: beams.Hits, xyz: F64, sample: Sample, ctx: Context
    ) -> U8:
        """A colour for each point (N, 3)."""
        if self.color_transformer == "FlatColor":
            return np.tile(np.array(self.color, dtype=np.uint8), (len(xyz), 1))
        if self.color_transformer == "AxisColor":
            places = transformed(sample.pose, xyz) if self.use_fixed_frame else xyz
            values = places[:, _AXES.index(self.axis)]
            limits = self.autocompute_value_bounds
            low, high = limits.min_value, limits.max_value
            if limits.value:
                low, high = bounds(values, _LEAST_SPAN)
            return rainbow(fractions(values, low, high))
        values = self._channel(scan, hits, xyz, sample, ctx)
        low, high = self.min_intensity, self.max_intensity
        if self.autocompute_intensity_bounds:
            low, high = bounds(values)
        where = fractions(values, low, high)
        if not self.use_rainbow:
            return ramp(where, self.min_color, self.max_color)
        return rainbow(1.0 - where if self.invert_rainbow else where)

    def _channel(
        self, scan: messages.LaserScan, hits: beams.Hits, xyz: F64, sample: Sample, ctx: Context
    ) -> F64:
        """The numbers (N,) that are coloured."""
        if self.channel_name in ("x", "y", "z"):
            return transformed(sample.pose, xyz)[:, "xyz".index(self.channel_name)]
        if self.channel_name == "intensity":
            count = len(scan.intensities)
            if count == hits.total:
                return scan.intensities[hits.beams].astype(np.float64)
            if count:
                ctx.warn(
                    "Intensity",
                    f"The scan has {count} intensities for {hits.total} ranges; "
                    "the points are coloured by range.",
                )
            else:
                ctx.ok("Intensity", "The scan has no intensities; it is coloured by range.")
        return scan.ranges[hits.beams].astype(np.float64)


# A pixel dot is a line so short that only its width is seen; along no axis, so that it is hardly
# ever seen from its end, where it would vanish.
_DOT = np.array((0.2e-3, 0.3e-3, 0.9e-3))
