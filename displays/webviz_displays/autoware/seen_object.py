"""Objects of Autoware's three kinds of messages in one form."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz.data.messages import PoseSequence
from webviz.data.rotations import matrices, normalized
from webviz_displays.shared.geometry import LONGEST, is_drawable

F64 = NDArray[np.float64]

CLASSES = (
    *("UNKNOWN", "CAR", "TRUCK", "BUS", "TRAILER", "MOTORCYCLE", "CYCLIST", "PEDESTRIAN"),
    *("ANIMAL", "HAZARD"),
)
"""Names by the label of an ObjectClassification; others are unknown."""
AVAILABLE = 2
"""`orientation_availability` of an object whose front is known."""


class SeenObject(msgspec.Struct, frozen=True, eq=False):
    """An object that can be drawn.

    Args:
        number: in the message.
        name: of its class.
        probability: that it exists.
        uuid: its id in hexadecimal digits, "" if it has none.
        xyz: (3,), metres in the frame of the message.
        turn: (3, 3), its rotation.
        kind: of its shape.
        size: (3,), metres.
        footprint: (N, 2), metres in its own frame.
        is_known: whether its front is known.
        velocity: (3,), m/s in its own frame; zero if it is invalid.
        yaw_rate: rad/s, zero if it is invalid.
        acceleration: (3,), m/s²; None if messages of this kind have none.
        pose_covariance, twist_covariance: (6, 6).
        paths: that it may take, with their confidences.
    """

    number: int
    name: str
    probability: float
    uuid: str
    xyz: F64
    turn: F64
    kind: int
    size: F64
    footprint: F64
    is_known: bool
    velocity: F64
    yaw_rate: float
    acceleration: F64 | None
    pose_covariance: F64
    twist_covariance: F64
    paths: Sequence[tuple[PoseSequence, float]]

    @property
    def speed(self) -> float:
        """Speed, in m/s."""
        return float(np.linalg.norm(self.velocity))

    @property
    def title(self) -> str:
        """Class and the first digits of the id."""
        return f"{self.name} {self.uuid[:4]}".rstrip()

    def placed(self, points: F64) -> F64:
        """Points (..., 3) of its own frame in the frame of the message."""
        return points @ self.turn.T + self.xyz


def object_of(number: int, item: Any) -> SeenObject | None:
    """Return an object of a message, None if its pose or shape cannot be drawn."""
    kinematics = item.kinematics
    pose = _of(kinematics, "pose_with_covariance")
    twist = _of(kinematics, "twist_with_covariance")
    accel = _of(kinematics, "acceleration_with_covariance")
    p, q = pose.pose.position, pose.pose.orientation
    xyz, wxyz = np.array((p.x, p.y, p.z)), np.array((q.w, q.x, q.y, q.z))
    d = item.shape.dimensions
    size = np.array((d.x, d.y, d.z))
    footprint = np.asarray(item.shape.footprint.points, np.float64).reshape(-1, 3)[:, :2]
    lengths = np.concatenate((size, footprint.ravel()))
    if not is_drawable(xyz) or not np.isfinite(wxyz).all() or not _are_metres(lengths):
        return None
    if (size < 0).any():
        return None
    (turn,) = matrices(normalized(wxyz)[0])
    id = getattr(item, "object_id", None)
    classes = sorted(item.classification, key=lambda each: each.probability)
    label = classes[-1].label if classes else 0
    return SeenObject(
        number,
        CLASSES[label] if label < len(CLASSES) else CLASSES[0],
        float(item.existence_probability),
        "" if id is None else bytes(id.uuid).hex(),
        xyz,
        turn,
        item.shape.type,
        size,
        footprint,
        getattr(kinematics, "orientation_availability", AVAILABLE) == AVAILABLE,
        _vector(twist.twist.linear),
        float(_vector(twist.twist.angular)[2]),
        None if accel is None else _vector(accel.accel.linear),
        np.asarray(pose.covariance, np.float64).reshape(6, 6),
        np.asarray(twist.covariance, np.float64).reshape(6, 6),
        [
            (each.path, float(each.confidence))
            for each in getattr(kinematics, "predicted_paths", ())
        ],
    )


def _of(kinematics: Any, name: str) -> Any:
    """Return a part of the kinematics, which predicted objects call initial.

    None if it has none.
    """
    return getattr(kinematics, name, getattr(kinematics, f"initial_{name}", None))


def _are_metres(values: F64) -> bool:
    return bool((np.abs(values) < LONGEST).all())


def _vector(item: Any) -> F64:
    """Return a geometry_msgs/msg/Vector3; zero if it is not finite or too large."""
    values = np.array((item.x, item.y, item.z))
    return values if _are_metres(values) else np.zeros(3)
