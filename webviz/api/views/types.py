"""The types of views, as in RViz. Lengths in metres, angles in radians.

The coordinates of a view have their origin at the target frame and the axes of the fixed frame; for
a ThirdPersonFollower they also rotate with the yaw of the target frame.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

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


class TopDownOrtho(_View, frozen=True, kw_only=True, tag="TopDownOrtho"):
    """Looks straight down without perspective; centred on `x`, `y`, `scale` in px/m."""

    scale: Annotated[float, Prop(ge=1e-5, le=1e6, unit="px/m", help="Size of the picture.")] = 10.0
    angle: Annotated[Angle, Prop(unit="rad", help="Rotation of the picture.")] = 0.0
    x: Middle = 0.0
    y: Middle = 0.0


View = Orbit | XYOrbit | ThirdPersonFollower | FPS | TopDownOrtho

VIEW_TYPES: dict[str, type[View]] = {
    cls.__name__: cls for cls in (Orbit, XYOrbit, ThirdPersonFollower, FPS, TopDownOrtho)
}
"""By their names in RViz and config files."""


def with_type(values: Any) -> Any:
    """Return the values of a view from a config file, where the type defaults to Orbit."""
    return {"type": "Orbit", **values} if isinstance(values, Mapping) else values


def type_of(view: View) -> str:
    """Return the name of the type of a view."""
    return type(view).__name__


def target_group(frame: str) -> str:
    """Return the group of the scene that views of a target frame follow."""
    return f"target frame/{frame}"
