"""Messages of Autoware's planning, perception and localization."""

from __future__ import annotations

import math
from typing import Any

Values = dict[str, Any]

PATH, TRAJECTORY = "autoware_planning_msgs/msg/Path", "autoware_planning_msgs/msg/Trajectory"
POSE = "geometry_msgs/msg/PoseStamped"


def pose_at(x: float, y: float, z: float = 0.0, yaw: float = 0.0) -> Values:
    """A pose that looks along the ground."""
    turn = {"z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}
    return {"position": {"x": x, "y": y, "z": z}, "orientation": turn}


def planned(*points: tuple[float, float, float], speeds: tuple[float, ...] = ()) -> list[Values]:
    """Points of a path along x, which is faster from point to point, half a second apart."""
    fast = speeds or tuple(float(number) for number in range(len(points)))
    return [
        {
            "pose": pose_at(*point),
            "longitudinal_velocity_mps": speed,
            "lateral_velocity_mps": 0.25,
            "heading_rate_rps": 0.125,
        }
        for point, speed in zip(points, fast, strict=True)
    ]


WAY = planned((0.0, 0.0, 0.0), (1.0, 0.0, 0.1), (2.0, 0.0, 0.3), (4.0, 0.0, 0.3))
BOUNDED = {
    "points": WAY,
    "left_bound": [{"x": 0.0, "y": 3.0}, {"x": 4.0, "y": 3.0}],
    "right_bound": [{"x": 0.0, "y": -3.0}, {"x": 4.0, "y": -3.0}],
}
"""A path between two bounds."""
TIMED = {
    "points": [
        {**point, "time_from_start": {"nanosec": 250_000_000 * number}, "acceleration_mps2": 0.5}
        for number, point in enumerate(WAY)
    ]
}
"""A trajectory along the same points."""
PASSED = [{"pose": pose_at(x, y)} for x, y in ((0.0, 0.0), (1.0, 0.5), (2.0, 0.0))]

PACKAGE = "autoware_perception_msgs/msg"
DETECTED, TRACKED = f"{PACKAGE}/DetectedObjects", f"{PACKAGE}/TrackedObjects"
PREDICTED = f"{PACKAGE}/PredictedObjects"
COVARIANCE = [{0: 0.09, 7: 0.04, 35: 0.04}.get(number, 0.0) for number in range(36)]
"""Deviations of 0.3 and 0.2 along x and y, and of 0.2 about z."""
FOOTPRINT = [{"x": x, "y": y} for x, y in ((0.4, 0.0), (-0.2, 0.3), (-0.2, -0.3))]


def thing(label: int, pose: Values, *size: float, kind: int = 0, **more: Any) -> Values:
    """An object, most likely of a class, that goes ahead at 2 m/s and turns."""
    x, y, z = size
    return {
        "existence_probability": 0.75,
        "classification": [{"label": 0, "probability": 0.1}, {"label": label, "probability": 0.8}],
        "shape": {
            "type": kind,
            "dimensions": {"x": x, "y": y, "z": z},
            "footprint": {"points": FOOTPRINT},
        },
        "kinematics": moving(pose),
        **more,
    }


def moving(pose: Values, initial: str = "") -> Values:
    """Kinematics, whose parts predicted objects call initial."""
    twist = {"linear": {"x": 2.0}, "angular": {"z": 0.5}}
    accel = {"linear": {"x": 3.0, "y": 4.0}}
    return {
        f"{initial}pose_with_covariance": {"pose": pose, "covariance": COVARIANCE},
        f"{initial}twist_with_covariance": {"twist": twist, "covariance": COVARIANCE},
        f"{initial}acceleration_with_covariance": {"accel": accel},
    }


def unaccelerated(values: Values) -> Values:
    """An object as detectors have it, whose front may be its back."""
    kinematics = {k: v for k, v in values["kinematics"].items() if "acceleration" not in k}
    return {**values, "kinematics": {**kinematics, "orientation_availability": 1}}


CAR = thing(1, pose_at(0.0, 0.0, 0.5, math.pi / 2), 2.0, 1.0, 1.0)
MAN = thing(7, pose_at(2.0, 0.0, 0.5), 0.5, 0.5, 1.0, kind=1)
HEAP = thing(99, pose_at(-1.0, 1.0, 0.2), 0.0, 0.0, 0.4, kind=2)
THINGS = (CAR, MAN, HEAP)
"""A car along y, a pedestrian, and a polygon of no known class."""


def identified(values: Values, number: int) -> Values:
    """An object with an id."""
    return {**values, "object_id": {"uuid": [16 * number + number] * 16}}


def expected(values: Values, number: int) -> Values:
    """An object with two paths ahead."""
    place = values["kinematics"]["pose_with_covariance"]["pose"]
    x, y = place["position"]["x"], place["position"]["y"]
    paths = [
        {"path": [pose_at(x + i / 2, y + side * i * i, 0.5) for i in range(5)], "confidence": 0.5}
        for side in (0.0, 0.1)
    ]
    kinematics = {**moving(place, "initial_"), "predicted_paths": paths}
    return {**identified(values, number), "kinematics": kinematics}


def followed(values: Values, number: int) -> Values:
    """An object whose front is known; the second stands."""
    kinematics = {"is_stationary": number == 1, "orientation_availability": 2}
    return identified({**values, "kinematics": {**values["kinematics"], **kinematics}}, number)


def messages_of(things: tuple[Values, ...]) -> tuple[Values, Values, Values]:
    """Things that are detected, tracked and predicted."""
    numbered = list(enumerate(things))
    return (
        {"objects": [unaccelerated(each) for each in things]},
        {"objects": [followed(each, number) for number, each in numbered]},
        {"objects": [expected(each, number) for number, each in numbered]},
    )


DETECTED_OBJECTS, FOLLOWED, FORESEEN = messages_of(THINGS)
ALL_FOUND, ALL_FOLLOWED, ALL_FORESEEN = messages_of(
    (*THINGS, *(thing(label, pose_at(0.0, float(label)), 1.0, 1.0, 1.0) for label in range(10)))
)
"""One of each class, too."""


AUTOWARE_MESSAGES: dict[str, Values] = {
    PATH: BOUNDED,
    TRAJECTORY: TIMED,
    DETECTED: DETECTED_OBJECTS,
    TRACKED: FOLLOWED,
    PREDICTED: FORESEEN,
}
"""A message of each type that draws something."""
