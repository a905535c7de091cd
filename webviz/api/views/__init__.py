"""Views, as RViz has them, and their cameras."""

from webviz.api.views.mimic import Rig, focus, mimic, rig_of
from webviz.api.views.placement import (
    ASSUMED_PX,
    FIELD_OF_VIEW,
    Camera,
    camera_of,
    view_of,
    zero,
)
from webviz.api.views.types import (
    FIXED_FRAME,
    FPS,
    VIEW_TYPES,
    FrameAligned,
    Orbit,
    ThirdPersonFollower,
    TopDownOrtho,
    View,
    XYOrbit,
    like,
    options_of,
    target_group,
    type_of,
    with_type,
)

__all__ = [
    "ASSUMED_PX",
    "FIELD_OF_VIEW",
    "FIXED_FRAME",
    "FPS",
    "VIEW_TYPES",
    "Camera",
    "FrameAligned",
    "Orbit",
    "Rig",
    "ThirdPersonFollower",
    "TopDownOrtho",
    "View",
    "XYOrbit",
    "camera_of",
    "focus",
    "like",
    "mimic",
    "options_of",
    "rig_of",
    "target_group",
    "type_of",
    "view_of",
    "with_type",
    "zero",
]
