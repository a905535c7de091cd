"""Views, as RViz has them, and their cameras."""

from webviz.api.views.mimic import Rig, focus, mimic, rig_of
from webviz.api.views.placement import FIELD_OF_VIEW, Camera, camera_of, view_of
from webviz.api.views.types import (
    FIXED_FRAME,
    FPS,
    VIEW_TYPES,
    Orbit,
    ThirdPersonFollower,
    TopDownOrtho,
    View,
    XYOrbit,
    target_group,
    type_of,
    with_type,
)

__all__ = [
    "FIELD_OF_VIEW",
    "FIXED_FRAME",
    "FPS",
    "VIEW_TYPES",
    "Camera",
    "Orbit",
    "Rig",
    "ThirdPersonFollower",
    "TopDownOrtho",
    "View",
    "XYOrbit",
    "camera_of",
    "focus",
    "mimic",
    "rig_of",
    "target_group",
    "type_of",
    "view_of",
    "with_type",
]
