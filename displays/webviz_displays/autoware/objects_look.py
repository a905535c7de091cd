"""Properties of Autoware's objects, as its plug-in for RViz has them."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec

from webviz import Color, Prop, Rgb

ON = ("value", True)
WHITE, BLUE, MAROON = (255, 255, 255), (30, 144, 255), (119, 11, 32)
PINK, HOT_PINK, RED = (255, 192, 203), (255, 105, 180), (255, 69, 0)


class ClassColors(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One colour per class of objects."""

    value: Annotated[bool, Prop(help="Use these colours instead of one for all.")] = False
    unknown: Annotated[Color, Prop(rviz="UNKNOWN", when=ON, help="Colour of other objects.")] = (
        WHITE
    )
    car: Annotated[Color, Prop(rviz="CAR", when=ON, help="Colour of cars.")] = BLUE
    truck: Annotated[Color, Prop(rviz="TRUCK", when=ON, help="Colour of trucks.")] = BLUE
    bus: Annotated[Color, Prop(rviz="BUS", when=ON, help="Colour of buses.")] = BLUE
    trailer: Annotated[Color, Prop(rviz="TRAILER", when=ON, help="Colour of trailers.")] = BLUE
    motorcycle: Annotated[
        Color, Prop(rviz="MOTORCYCLE", when=ON, help="Colour of motorcycles.")
    ] = MAROON
    cyclist: Annotated[Color, Prop(rviz="CYCLIST", when=ON, help="Colour of bicycles.")] = MAROON
    pedestrian: Annotated[
        Color, Prop(rviz="PEDESTRIAN", when=ON, help="Colour of pedestrians.")
    ] = PINK
    animal: Annotated[Color, Prop(rviz="ANIMAL", when=ON, help="Colour of animals.")] = HOT_PINK
    hazard: Annotated[Color, Prop(rviz="HAZARD", when=ON, help="Colour of hazards.")] = RED

    def of(self, name: str) -> Rgb:
        """Return the colour of a class by its name in capitals."""
        return getattr(self, name.lower())


class ShapeView(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Appearance of the shapes."""

    shape_type: Annotated[
        Literal["Skeleton 3D", "Skeleton 2D", "Fill", "None"],
        Prop(help="Draw edges, those of the base, solids, or nothing."),
    ] = "Skeleton 3D"
    bbox_footprint: Annotated[
        bool,
        Prop(rviz="BBox Footprint", help="Draw the footprint of boxes, too, if they have one."),
    ] = False


class MeasuredTexts(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Texts at detected objects."""

    label: Annotated[bool, Prop(help="Show the class.")] = True
    velocity: Annotated[bool, Prop(help="Show the speed in km/h.")] = False
    existence_probability: Annotated[bool, Prop(help="Show the probability.")] = False


class TrackedTexts(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Texts at objects with an id."""

    label: Annotated[bool, Prop(help="Show the class.")] = True
    uuid: Annotated[bool, Prop(rviz="UUID", help="Show the first digits of the id.")] = True
    velocity: Annotated[bool, Prop(help="Show the speed in km/h.")] = False
    acceleration: Annotated[bool, Prop(help="Show the acceleration in m/s².")] = False
    existence_probability: Annotated[bool, Prop(help="Show the probability.")] = False


class PredictedPaths(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Appearance of predicted paths."""

    predicted_path: Annotated[bool, Prop(help="Draw the paths.")] = True
    path_confidence: Annotated[bool, Prop(help="Show how likely each path is.")] = True
    path_footprint: Annotated[bool, Prop(help="Draw the shape at each pose of a path.")] = False
    path_resolution: Annotated[
        Literal["Normal", "Simple"],
        Prop(help="Simple draws arrows and shapes at every other pose."),
    ] = "Normal"


class ObjectVectors(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Velocities as lines."""

    twist: Annotated[bool, Prop(help="Draw where objects are after 1 s.")] = True
    yaw_rate: Annotated[bool, Prop(help="Draw how far they turn in 1 s.")] = False


class ObjectCovariances(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Uncertainties of poses and velocities."""

    pose: Annotated[bool, Prop(help="Draw ellipses of positions.")] = True
    yaw: Annotated[bool, Prop(help="Draw sectors of headings.")] = False
    twist: Annotated[bool, Prop(help="Draw ellipses of velocities.")] = False
    yaw_rate: Annotated[bool, Prop(help="Draw intervals of yaw rates.")] = False
    confidence_interval: Annotated[
        Literal["70%", "85%", "95%", "99%"], Prop(help="How likely the true value is inside.")
    ] = "95%"
