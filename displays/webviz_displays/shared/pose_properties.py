"""Properties that displays of poses have in common."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec

from webviz import Color, Prop


class PoseShape(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """How to draw a pose."""

    value: Annotated[
        Literal["Arrow", "Axes"], Prop(help="An arrow along x, or all three axes.")
    ] = "Arrow"
    color: Annotated[Color, Prop(when=("value", "Arrow"), help="Colour of the arrows.")] = (
        255,
        25,
        0,
    )
    alpha: Annotated[
        float,
        Prop(
            ge=0,
            le=1,
            widget="slider",
            when=("value", "Arrow"),
            help="Opacity of the arrows, 0 is invisible.",
        ),
    ] = 1.0
    shaft_length: Annotated[
        float, Prop(ge=0, unit="m", when=("value", "Arrow"), help="Length of the shaft.")
    ] = 1.0
    shaft_radius: Annotated[
        float, Prop(gt=0, unit="m", when=("value", "Arrow"), help="Radius of the shaft.")
    ] = 0.05
    head_length: Annotated[
        float, Prop(gt=0, unit="m", when=("value", "Arrow"), help="Length of the head.")
    ] = 0.3
    head_radius: Annotated[
        float, Prop(gt=0, unit="m", when=("value", "Arrow"), help="Radius of the head.")
    ] = 0.1
    axes_length: Annotated[
        float, Prop(gt=0, unit="m", when=("value", "Axes"), help="Length of each axis.")
    ] = 1.0
    axes_radius: Annotated[
        float, Prop(gt=0, unit="m", when=("value", "Axes"), help="Radius of each axis.")
    ] = 0.1


class PositionCovariance(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """How to draw the uncertainty of positions: ellipses, or ellipsoids."""

    value: Annotated[bool, Prop(help="Draw it.")] = True
    color: Annotated[Color, Prop(when=("value", True), help="Colour of the ellipses.")] = (
        204,
        51,
        204,
    )
    alpha: Annotated[
        float,
        Prop(ge=0, le=1, widget="slider", when=("value", True), help="0 is invisible, 1 opaque."),
    ] = 0.3
    scale: Annotated[
        float, Prop(gt=0, when=("value", True), help="Standard deviations from middle to rim.")
    ] = 1.0


class OrientationCovariance(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """How to draw the uncertainty of orientations: wedges, or discs at the tips of the axes."""

    value: Annotated[bool, Prop(help="Draw it.")] = True
    frame: Annotated[
        Literal["Local", "Fixed"],
        Prop(
            when=("value", True),
            help="Along the axes of the robot, or of the frame its pose is given in.",
        ),
    ] = "Local"
    color_style: Annotated[
        Literal["Unique", "RGB"],
        Prop(when=("value", True), help="One colour, or a colour for each axis."),
    ] = "Unique"
    color: Annotated[Color, Prop(when=("color_style", "Unique"), help="The one colour.")] = (
        255,
        255,
        127,
    )
    alpha: Annotated[
        float,
        Prop(ge=0, le=1, widget="slider", when=("value", True), help="0 is invisible, 1 opaque."),
    ] = 0.5
    offset: Annotated[
        float,
        Prop(gt=0, unit="m", when=("value", True), help="Where it is drawn, from the position."),
    ] = 1.0
    scale: Annotated[
        float, Prop(gt=0, when=("value", True), help="Standard deviations from middle to rim.")
    ] = 1.0


class Covariance(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """How to draw the uncertainty of poses."""

    value: Annotated[bool, Prop(help="Draw it.")] = True
    position: Annotated[
        PositionCovariance, Prop(when=("value", True), help="Uncertainty of positions.")
    ] = PositionCovariance()
    orientation: Annotated[
        OrientationCovariance, Prop(when=("value", True), help="Uncertainty of orientations.")
    ] = OrientationCovariance()
