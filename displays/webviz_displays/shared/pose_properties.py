"""Properties shared by the displays of poses."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec

from webviz import Color, Prop
from webviz_displays.shared.colors import Alpha
from webviz_displays.shared.geometry import Metres


class PoseShape(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Appearance of a pose."""

    value: Annotated[
        Literal["Arrow", "Axes"], Prop(help="Draw an arrow along x, or all three axes.")
    ] = "Arrow"
    color: Annotated[Color, Prop(when=("value", "Arrow"), help="Colour of the arrows.")] = (
        255,
        25,
        0,
    )
    alpha: Annotated[
        Alpha, Prop(when=("value", "Arrow"), help="Opacity of the arrows; 0 is invisible.")
    ] = 1.0
    shaft_length: Annotated[
        float, Prop(ge=0, unit="m", when=("value", "Arrow"), help="Length of the shaft.")
    ] = 1.0
    shaft_radius: Annotated[
        Metres, Prop(when=("value", "Arrow"), rviz_factor=2.0, help="Radius of the shaft.")
    ] = 0.05
    head_length: Annotated[Metres, Prop(when=("value", "Arrow"), help="Length of the head.")] = 0.3
    head_radius: Annotated[
        Metres, Prop(when=("value", "Arrow"), rviz_factor=2.0, help="Radius of the head.")
    ] = 0.1
    axes_length: Annotated[Metres, Prop(when=("value", "Axes"), help="Length of each axis.")] = 1.0
    axes_radius: Annotated[
        Metres, Prop(when=("value", "Axes"), rviz_factor=2.0, help="Radius of each axis.")
    ] = 0.1


class PositionCovariance(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Appearance of the uncertainty of positions: ellipses or ellipsoids."""

    value: Annotated[bool, Prop(help="Draw this covariance.")] = True
    color: Annotated[Color, Prop(when=("value", True), help="Colour of the ellipses.")] = (
        204,
        51,
        204,
    )
    alpha: Annotated[Alpha, Prop(when=("value", True), help="Opacity; 0 is invisible.")] = 0.3
    scale: Annotated[
        float, Prop(gt=0, when=("value", True), help="Size in standard deviations.")
    ] = 1.0


class OrientationCovariance(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Appearance of the uncertainty of orientations: wedges, or discs at the tips of the axes."""

    value: Annotated[bool, Prop(help="Draw this covariance.")] = True
    frame: Annotated[
        Literal["Local", "Fixed"],
        Prop(
            when=("value", True),
            help="Draw along the robot's axes, or those of the frame of its pose.",
        ),
    ] = "Local"
    color_style: Annotated[
        Literal["Unique", "RGB"],
        Prop(when=("value", True), help="Use one colour, or one per axis."),
    ] = "Unique"
    color: Annotated[
        Color, Prop(when=("color_style", "Unique"), help="Colour of the wedges and discs.")
    ] = (255, 255, 127)
    alpha: Annotated[Alpha, Prop(when=("value", True), help="Opacity; 0 is invisible.")] = 0.5
    offset: Annotated[
        Metres, Prop(when=("value", True), help="Distance from the position at which it is drawn.")
    ] = 1.0
    scale: Annotated[
        float, Prop(gt=0, when=("value", True), help="Size in standard deviations.")
    ] = 1.0


class Covariance(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Appearance of the uncertainty of poses."""

    value: Annotated[bool, Prop(help="Draw this covariance.")] = True
    position: Annotated[
        PositionCovariance, Prop(when=("value", True), help="How to draw the position covariance.")
    ] = PositionCovariance()
    orientation: Annotated[
        OrientationCovariance,
        Prop(when=("value", True), help="How to draw the orientation covariance."),
    ] = OrientationCovariance()
