"""Base of the displays of points: RViz's properties of point clouds."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import msgspec
import numpy as np
from numpy.typing import ArrayLike, NDArray

from webviz import Color, ColorScale, Context, Display, Group, Keep, Pose, Prop, Rgb, Solid, Topic
from webviz.api.nodes import Plane
from webviz_displays.shared.colors import RAINBOW, Alpha, bounds, ramp
from webviz_displays.shared.geometry import Metres, coordinate

U8 = NDArray[np.uint8]
F32 = NDArray[np.float32]

BY_INTENSITY = ("color_transformer", ("Intensity", "Auto"))
"""Condition for options of this transformer; Auto may choose it too."""
BY_AXIS = ("color_transformer", ("AxisColor", "Auto"))
"""Condition for options of this transformer."""

DOTS_LIMIT = 50_000
"""The browser draws the style Points as lines, and slows down with more of them."""
SOLIDS_LIMIT = 20_000
"""A browser without a GPU draws this many lit solids once a second."""

_SOLIDS: dict[str, Solid] = {"Boxes": "box", "Spheres": "sphere", "Tiles": "square"}

_AXES = ("X", "Y", "Z")
_LEAST_SPAN = 1e-3
"""Metres; heights in a planar scan differ by rounding only, which must not make a rainbow."""

# A pixel dot is a line too short to show more than its width; along no axis, so that it is hardly
# ever seen from its end, where it would vanish.
_DOT = np.array((0.2e-3, 0.3e-3, 0.9e-3), np.float32)


class ValueBounds(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The range of coordinates of AxisColor's rainbow."""

    value: Annotated[bool, Prop(help="Compute the bounds from the points of each message.")] = True
    min_value: Annotated[
        float, Prop(unit="m", when=("value", False), help="Coordinate drawn in red.")
    ] = -10.0
    max_value: Annotated[
        float, Prop(unit="m", when=("value", False), help="Coordinate drawn in magenta.")
    ] = 10.0


class PointStyle(Display):
    """Base of displays that draw points."""

    topic: Annotated[Topic, Prop(help="Topic of the points.")] = Topic()
    style: Annotated[
        Literal["Points", "Squares", "Flat Squares", "Spheres", "Boxes", "Tiles"],
        Prop(help="Shape of each point; Squares face the camera, Tiles lie along x and y."),
    ] = "Flat Squares"
    size: Annotated[Metres, Prop(rviz="Size (m)", help="Edge or diameter of each point.")] = 0.01
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
        Alpha,
        Prop(help="Opacity of each point; those that lie over each other add up."),
    ] = 1.0
    selectable: Annotated[bool, Prop(help="Let the tool Select pick points.")] = True
    decay_time: Annotated[
        float, Prop(ge=0, unit="s", help="How long to keep messages; 0 shows only the newest.")
    ] = 0.0

    def history(self) -> Keep:
        """Return the messages within the decay time, or the newest."""
        return Keep(count=0, seconds=self.decay_time) if self.decay_time else Keep()

    def draw_points(
        self,
        xyz: NDArray[Any],
        colors: U8 | Rgb,
        group: Group,
        ctx: Context,
        box_wxyz: ArrayLike | None = None,
        ids: NDArray[Any] | None = None,
        size: float | None = None,
        plane: Plane | None = None,
        thins: bool = False,
        of: int = 0,
        opacity: float = 1.0,
    ) -> None:
        """Draw points in the chosen style.

        Args:
            xyz: points (N, 3), finite.
            colors: (N, 3) or one for all.
            group: where to draw.
            ctx: collects statuses.
            box_wxyz: quaternion (4,) that turns boxes and tiles in the coordinates of the group;
                None leaves their sides along its axes.
            ids: (N,), index of each in the message; None if all are drawn.
            size: edge or diameter in metres; None is the property.
            plane: the size is that at 1 m from this plane, and grows with the distance.
            thins: whether browsers may draw only some of them, which are in an order for
                `Points.thins`; not for the style Points.
            of: number of all points of the display, if it draws them in several nodes.
            opacity: that of these points, by which `alpha` is multiplied.
        """
        alpha, layer = self.alpha * opacity, "" if opacity == 1.0 else f" {round(255 * opacity)}"
        size = self.size if size is None else size
        total = of or len(xyz)
        too_many = thins or total > SOLIDS_LIMIT
        if self.style in _SOLIDS and not too_many:
            wxyzs = None if box_wxyz is None else np.tile(np.asarray(box_wxyz), (len(xyz), 1))
            shape = _SOLIDS[self.style]
            scales = size if plane is None else size * (xyz @ plane[:3] + plane[3])[:, None]
            key = f"solids{layer}"
            group.instances(key, shape, xyz, scales, colors, wxyzs, alpha, True, ids)
            return
        if self.style == "Points":
            dots = np.stack((xyz - _DOT / 2, xyz + _DOT / 2), axis=1)
            if not isinstance(colors, tuple):
                colors = np.repeat(colors[:, None], 2, axis=1)
            key = f"points{layer}"
            group.lines(key, dots, colors, self.size_pixels, ids=ids, opacity=alpha)
            return
        outline = "circle" if self.style == "Spheres" else "square"
        if self.style in _SOLIDS:
            ctx.ok(
                "Style",
                f"{self.style} are drawn as {'discs' if outline == 'circle' else 'squares'} that "
                f"face the camera: the limit is {SOLIDS_LIMIT} solids, got {total} points.",
            )
        elif self.style != "Flat Squares":
            ctx.ok("Style", f"{self.style} are drawn as flat squares that face the camera.")
        key = "blocks" if thins else "points"  # nodes do not begin or cease to be thinned
        group.points(key + layer, xyz, colors, size, outline, ids, thins, alpha, plane)


InvertRainbow = Annotated[
    bool, Prop(when=("use_rainbow", True), help="Colour from magenta (low) to red (high).")
]
MinColor = Annotated[Color, Prop(when=("use_rainbow", False), help="Colour of the lowest value.")]
MaxColor = Annotated[Color, Prop(when=("use_rainbow", False), help="Colour of the highest value.")]
MinIntensity = Annotated[
    float,
    Prop(when=("autocompute_intensity_bounds", False), help="Value that gets the minimum colour."),
]
MaxIntensity = Annotated[
    float,
    Prop(when=("autocompute_intensity_bounds", False), help="Value that gets the maximum colour."),
]


class PointsDisplay(PointStyle):
    """Base of displays that colour points by a value."""

    # Each display has its own choices of these two.
    color_transformer: Any = "Intensity"
    channel_name: Any = "intensity"
    use_rainbow: Annotated[
        bool,
        Prop(
            rviz="Use rainbow",
            when=BY_INTENSITY,
            help="Colour from red (low) to magenta (high) instead of between two colours.",
        ),
    ] = True
    invert_rainbow: InvertRainbow = False
    min_color: MinColor = (0, 0, 0)
    max_color: MaxColor = (255, 255, 255)
    autocompute_intensity_bounds: Annotated[
        bool,
        Prop(when=BY_INTENSITY, help="Compute the lowest and highest value from each message."),
    ] = True
    min_intensity: MinIntensity = 0.0
    max_intensity: MaxIntensity = 4096.0
    color: Annotated[
        Color, Prop(when=("color_transformer", "FlatColor"), help="Colour of all points.")
    ] = (255, 255, 255)
    axis: Annotated[
        Literal["X", "Y", "Z"], Prop(when=BY_AXIS, help="Coordinate that determines the colour.")
    ] = "Z"
    autocompute_value_bounds: Annotated[
        ValueBounds, Prop(when=BY_AXIS, help="Bounds of the coordinate.")
    ] = ValueBounds()
    use_fixed_frame: Annotated[
        bool, Prop(when=BY_AXIS, help="Use coordinates in the fixed frame instead of the sensor's.")
    ] = True

    def axis_colors(self, xyz: NDArray[Any], own: Pose, fixed: Pose, ctx: Context) -> U8:
        """Colours (N, 3) of AxisColor.

        Args:
            xyz: points (N, 3).
            own: of their coordinates in the frame of the sensor.
            fixed: of their coordinates in the fixed frame.
            ctx: gets the colour scale.
        """
        pose = fixed if self.use_fixed_frame else own
        values, origin = coordinate(pose, xyz, _AXES.index(self.axis))
        limits = self.autocompute_value_bounds
        low, high = limits.min_value, limits.max_value
        if limits.value:
            low, high = (each + origin for each in bounds(values, _LEAST_SPAN))
        ctx.color_scale = ColorScale(f"{self.axis.lower()} (m)", low, high, RAINBOW)
        return ramp(values, low - origin, high - origin)

    def intensity_colors(self, values: ArrayLike, ctx: Context) -> U8:
        """Colours (N, 3) of Intensity for values (N,)."""
        low, high = self.min_intensity, self.max_intensity
        if self.autocompute_intensity_bounds:
            low, high = bounds(values)
        rainbow = RAINBOW[::-1] if self.invert_rainbow else RAINBOW
        stops = rainbow if self.use_rainbow else (self.min_color, self.max_color)
        ctx.color_scale = ColorScale(str(self.channel_name), low, high, stops)
        return ramp(values, low, high, stops)
