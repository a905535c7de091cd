"""The types of views, as in RViz. Lengths in metres, angles in radians.

The coordinates of a view have their origin at the target frame and the axes of the fixed frame; for
a ThirdPersonFollower they also rotate with the yaw of the target frame, and for a FrameAligned view
they are those of the target frame.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal, TypeVar

import msgspec

from webviz.api.declared import Prop

FIXED_FRAME = "<Fixed Frame>"
"""Target frame of a view that follows nothing."""

Length = Annotated[float, msgspec.Meta(ge=-1e9, le=1e9)]
Angle = Annotated[float, msgspec.Meta(ge=-1e6, le=1e6)]
Yaw = Annotated[Angle, Prop(unit="rad", help="Direction of the camera.")]
Pitch = Annotated[float, Prop(ge=-1.5698, le=1.5698, unit="rad", help="Positive looks down.")]
Middle = Annotated[Length, Prop(unit="m", help="Centre of the picture.")]
Point = tuple[Length, Length, Length]
Inverted = Annotated[bool, Prop(help="Turn the picture upside down, for z axes that point down.")]
Axis = Literal["arbitrary", "+x axis", "-x axis", "+y axis", "-y axis", "+z axis", "-z axis"]


class _View(
    msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, tag_field="type"
):
    target_frame: str = FIXED_FRAME


class _AroundAPoint(_View, frozen=True, kw_only=True):
    distance: Annotated[
        float, Prop(gt=0, le=1e6, unit="m", help="From the camera to the focal point.")
    ] = 10.0
    yaw: Yaw = 0.785398
    pitch: Pitch = 0.785398
    focal_point: Annotated[Point, Prop(unit="m", help="Centre of rotation.")] = (0.0, 0.0, 0.0)
    invert_z_axis: Inverted = False


class Orbit(_AroundAPoint, frozen=True, kw_only=True, tag="Orbit"):
    """Orbits a focal point at a distance, with yaw and pitch."""


class XYOrbit(_AroundAPoint, frozen=True, kw_only=True, tag="XYOrbit"):
    """Orbit with its focal point on the ground, slightly below the centre of the picture."""


class ThirdPersonFollower(_AroundAPoint, frozen=True, kw_only=True, tag="ThirdPersonFollower"):
    """XYOrbit that also rotates with the yaw of its target frame."""


class FPS(_View, frozen=True, kw_only=True, tag="FPS"):
    """Looks around from a position; a positive pitch looks down."""

    yaw: Yaw = 0.0
    pitch: Pitch = 0.0
    position: Annotated[Point, Prop(unit="m", help="Position of the camera.")] = (5.0, 5.0, 10.0)


class FrameAligned(FPS, frozen=True, kw_only=True, tag="FrameAligned"):
    """FPS that also rotates with its target frame; at first along an axis of that frame."""

    position: Annotated[Point, Prop(unit="m", help="Position of the camera.")] = (-5.0, 0.0, 0.0)
    point_towards: Annotated[
        Axis, Prop(rviz="Point towards", help="Axis of the target frame along which to look.")
    ] = "+x axis"
    lock_camera: Annotated[bool, Prop(help="Keep the camera where it is in the frame.")] = False
    invert_z_axis: Inverted = False


class TopDownOrtho(_View, frozen=True, kw_only=True, tag="TopDownOrtho"):
    """Looks straight down without perspective; centred on `x`, `y`, `scale` in px/m."""

    scale: Annotated[float, Prop(ge=1e-5, le=1e6, unit="px/m", help="Size of the picture.")] = 10.0
    angle: Annotated[Angle, Prop(unit="rad", help="Rotation of the picture.")] = 0.0
    x: Middle = 0.0
    y: Middle = 0.0


View = Orbit | XYOrbit | ThirdPersonFollower | FPS | FrameAligned | TopDownOrtho
V = TypeVar("V", bound=View)

VIEW_TYPES: dict[str, type[View]] = {
    cls.__name__: cls
    for cls in (Orbit, XYOrbit, ThirdPersonFollower, FPS, FrameAligned, TopDownOrtho)
}
"""Types of views by their names in RViz and config files."""
OPTIONS = "target_frame", "invert_z_axis", "point_towards", "lock_camera"
"""Fields that moving the camera leaves."""


def with_type(values: Any) -> Any:
    """Return the values of a view from a config file, where the type defaults to Orbit."""
    return {"type": "Orbit", **values} if isinstance(values, Mapping) else values


def type_of(view: View) -> str:
    """Return the name of the type of a view."""
    return type(view).__name__


def options_of(view: View) -> dict[str, str | bool]:
    """Return the fields of a view that moving its camera leaves."""
    return {name: getattr(view, name) for name in view.__struct_fields__ if name in OPTIONS}


def like(cls: type[V], view: View, target_frame: str | None = None) -> V:
    """Return the initial view of a type, with the options of another view.

    Args:
        cls: the type.
        view: with the options.
        target_frame: in place of the view's.
    """
    options: dict[str, Any] = {**options_of(view)}
    if target_frame is not None:
        options["target_frame"] = target_frame
    return cls(**{name: value for name, value in options.items() if name in cls.__struct_fields__})


def target_group(frame: str) -> str:
    """Return the group of the scene that views of a target frame follow."""
    return f"target frame/{frame}"
