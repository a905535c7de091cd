"""Messages for the displays of what cameras and lidars recognise, as those of `plain_scenes`."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

Values = dict[str, Any]
NAN = float("nan")

ZED_OBJECTS = "zed_msgs/msg/ObjectsStamped"


def zed_box(center: tuple[float, float, float], size: tuple[float, float, float]) -> Values:
    """Corners of an upright box, the upper four first."""
    (x, y, z), (a, b, c) = center, (each / 2 for each in size)
    around = ((-a, -b), (a, -b), (a, b), (-a, b))
    corners = [(x + i, y + j, z + k) for k in (c, -c) for i, j in around]
    return {"corners": [{"kp": corner} for corner in corners]}


def zed_keypoints(keypoints: Iterable[tuple[float, float, float]]) -> Values:
    """The joints of a skeleton; the rest of the 70 are zero, as the SDK's wrapper sends them."""
    points = [{"kp": each} for each in keypoints]
    return {"keypoints": points + [{"kp": (0.0, 0.0, 0.0)}] * (70 - len(points))}


STANDING = (
    *((0.0, 0.0, 1.1), (0.0, 0.0, 0.95)),
    *((0.0, -0.15, 0.9), (0.0, -0.2, 0.7), (0.1, -0.2, 0.6)),
    *((0.0, 0.15, 0.9), (0.0, 0.2, 0.7), (0.1, 0.2, 0.6)),
    *((0.0, -0.1, 0.6), (0.0, -0.1, 0.3), (0.0, -0.1, 0.05)),
    *((0.0, 0.1, 0.6), (0.0, 0.1, 0.3), (0.0, 0.1, 0.05)),
    *((0.05, -0.03, 1.15), (0.05, 0.03, 1.15), (0.0, -0.08, 1.13), (NAN, NAN, NAN)),
)
"""The 18 joints of a child in BODY_18, of which the left ear is not seen."""
ZED_CAR = {
    "label": "Vehicle",
    "label_id": 3,
    "sublabel": "Car",
    "confidence": 87.5,
    "position": (1.0, -0.5, 0.25),
    "velocity": (1.5, 0.0, 0.0),
    "tracking_available": True,
    "tracking_state": 1,
    "bounding_box_3d": zed_box((1.0, -0.5, 0.25), (0.8, 0.4, 0.5)),
    "dimensions_3d": (0.8, 0.4, 0.5),
}
ZED_PERSON = {
    "label": "Person",
    "label_id": 0,
    "sublabel": "Person",
    "position": (0.0, 0.0, 0.6),
    "bounding_box_3d": zed_box((0.0, 0.0, 0.6), (0.4, 0.5, 1.2)),
    "skeleton_available": True,
    "skeleton_3d": zed_keypoints(STANDING),
}
ZED_SCENE = {"objects": [ZED_CAR, ZED_PERSON]}
"""A car that is tracked, and a person that is not, with a skeleton."""


PERCEPTION_MESSAGES: dict[str, Values] = {
    ZED_OBJECTS: ZED_SCENE,
}
"""A message of each type that draws something."""
