"""Properties of Autoware's paths and trajectories, as its plug-in for RViz has them."""

from __future__ import annotations

from typing import Annotated

import msgspec

from webviz import Color, Prop
from webviz_displays.shared.colors import Alpha
from webviz_displays.shared.geometry import LONGEST, Metres

IF_ENABLED = ("value", True)


class LaneView(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Appearance of the lane that the vehicle covers, coloured by velocity."""

    value: Annotated[bool, Prop(help="Draw the lane.")] = True
    constant_width: Annotated[
        bool, Prop(when=IF_ENABLED, help="Use Width instead of the width of the vehicle.")
    ] = False
    width: Annotated[
        float,
        Prop(ge=0, le=LONGEST, unit="m", when=("constant_width", True), help="Width of the lane."),
    ] = 2.0
    alpha: Annotated[Alpha, Prop(when=IF_ENABLED, help="Opacity of the lane.")] = 1.0
    min_velocity_color: Annotated[Color, Prop(when=IF_ENABLED, help="Colour at standstill.")] = (
        63,
        46,
        227,
    )
    mid_velocity_color: Annotated[
        Color, Prop(when=IF_ENABLED, help="Colour at half of Color Border Vel Max.")
    ] = (32, 138, 174)
    max_velocity_color: Annotated[
        Color, Prop(when=IF_ENABLED, help="Colour at Color Border Vel Max and above.")
    ] = (0, 230, 120)
    fade_out_distance: Annotated[
        float, Prop(ge=0, unit="m", when=IF_ENABLED, help="Fade out this much of the end.")
    ] = 0.0
    constant_color: Annotated[
        bool, Prop(when=IF_ENABLED, help="Use Color, as older versions of the plug-in can.")
    ] = False
    color: Annotated[
        Color, Prop(when=("constant_color", True), help="Colour of the whole lane.")
    ] = (0, 0, 0)


class VelocityView(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Appearance of the velocities: a line that is higher where the vehicle is faster."""

    value: Annotated[bool, Prop(help="Draw the velocities.")] = True
    alpha: Annotated[Alpha, Prop(when=IF_ENABLED, help="Opacity of the line.")] = 1.0
    scale: Annotated[
        float, Prop(ge=0.1, le=10, when=IF_ENABLED, help="Height in metres of 1 m/s.")
    ] = 0.3
    constant_color: Annotated[
        bool, Prop(when=IF_ENABLED, help="Use Color instead of those of velocities.")
    ] = False
    color: Annotated[
        Color, Prop(when=("constant_color", True), help="Colour of the whole line.")
    ] = (0, 0, 0)


class TextView(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Appearance of numbers at the points."""

    value: Annotated[bool, Prop(help="Show the numbers.")] = False
    scale: Annotated[Metres, Prop(le=LONGEST, when=IF_ENABLED, help="Height of the numbers.")] = 0.3


class FootprintView(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Appearance of the vehicle's outline at each point, and its size."""

    value: Annotated[bool, Prop(help="Draw the outlines.")] = False
    alpha: Annotated[Alpha, Prop(when=IF_ENABLED, help="Opacity of the outlines.")] = 1.0
    color: Annotated[Color, Prop(when=IF_ENABLED, help="Colour of the outlines.")] = (230, 230, 50)
    vehicle_length: Annotated[
        float,
        Prop(ge=0, le=LONGEST, unit="m", when=IF_ENABLED, rviz="Vehicle Length", help="Length."),
    ] = 4.77
    vehicle_width: Annotated[
        float,
        Prop(
            ge=0,
            le=LONGEST,
            unit="m",
            rviz="Vehicle Width",
            help="Width, also of the lane unless its width is constant.",
        ),
    ] = 1.83
    rear_overhang: Annotated[
        float,
        Prop(
            ge=0,
            le=LONGEST,
            unit="m",
            when=IF_ENABLED,
            rviz="Rear Overhang",
            help="Length behind the rear axle, where the poses are.",
        ),
    ] = 1.03
    offset_from_baselink: Annotated[
        float,
        Prop(
            ge=-LONGEST,
            le=LONGEST,
            unit="m",
            when=IF_ENABLED,
            rviz="Offset from BaseLink",
            help="Leave out this length at both ends.",
        ),
    ] = 0.0


class PointView(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Appearance of the points as discs."""

    value: Annotated[bool, Prop(help="Draw the points.")] = False
    alpha: Annotated[Alpha, Prop(when=IF_ENABLED, help="Opacity of the points.")] = 1.0
    color: Annotated[Color, Prop(when=IF_ENABLED, help="Colour of the points.")] = (0, 60, 255)
    radius: Annotated[Metres, Prop(le=LONGEST, when=IF_ENABLED, help="Radius of the discs.")] = 0.1
    offset: Annotated[
        float,
        Prop(
            ge=-LONGEST, le=LONGEST, unit="m", when=IF_ENABLED, help="Place them this much ahead."
        ),
    ] = 0.0


class DrivableAreaView(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Appearance of the bounds of the drivable area."""

    value: Annotated[bool, Prop(help="Draw the bounds.")] = True
    alpha: Annotated[Alpha, Prop(when=IF_ENABLED, help="Opacity of the bounds.")] = 0.999
    color: Annotated[Color, Prop(when=IF_ENABLED, help="Colour of the bounds.")] = (0, 148, 205)
    width: Annotated[
        float, Prop(ge=0.001, le=LONGEST, unit="m", when=IF_ENABLED, help="Width of the bounds.")
    ] = 0.3
