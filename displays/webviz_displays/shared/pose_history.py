"""The poses of many messages as arrays."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import isfinite
from typing import Any

import msgspec
import numpy as np
from msgspec.structs import astuple
from numpy.typing import NDArray

from webviz import Sample
from webviz.data import messages
from webviz.data.rotations import matrices, multiply_many, normalized
from webviz_displays.shared.geometry import FARTHEST, is_drawable

F64 = NDArray[np.float64]
Mask = NDArray[np.bool_]

PoseOf = Callable[[Any], messages.Pose]
"""The pose of a message."""

UNIT_TOLERANCE = 0.01
"""Tolerance of the squared length of a quaternion around 1 (RViz's constant)."""


class PoseTrail(msgspec.Struct, frozen=True):
    """Poses of N samples in the fixed frame.

    Args:
        positions: (N, 3), metres; zero where they cannot be drawn.
        rotations: (N, 3, 3), of what has the pose, such as a robot.
        wxyzs: (N, 4), the same.
        frames: (N, 3, 3), rotations of the frames in which the messages give them.
        squares: (N,), squared lengths of the quaternions as sent.
        ok: (N,), whether a pose can be drawn.
    """

    positions: F64
    rotations: F64
    wxyzs: F64
    frames: F64
    squares: F64
    ok: Mask

    def __getitem__(self, rows: Any) -> PoseTrail:
        """Return some of the poses."""
        return PoseTrail(*(value[rows] for value in astuple(self)))


def fault(pose: messages.Pose) -> str:
    """Return a sentence why a pose cannot be drawn, "" if it can."""
    p, q = pose.position, pose.orientation
    if not all(map(isfinite, (p.x, p.y, p.z, q.x, q.y, q.z, q.w))):
        return (
            f"The pose is not finite: position ({p.x:g}, {p.y:g}, {p.z:g}), "
            f"orientation ({q.x:g}, {q.y:g}, {q.z:g}, {q.w:g})."
        )
    if max(abs(p.x), abs(p.y), abs(p.z)) >= FARTHEST:
        return f"The position ({p.x:g}, {p.y:g}, {p.z:g}) is too far away to be drawn."
    return ""


class GrowingTrail:
    """Trails of a list of samples that grows at its end and shrinks at its start.

    Args:
        pose_of: the pose of each message.
    """

    def __init__(self, pose_of: PoseOf) -> None:
        self._pose_of = pose_of
        self._samples: list[Sample] = []
        self._trail = trail([], pose_of)

    def of(self, samples: Sequence[Sample]) -> PoseTrail:
        """`trail` of these samples; only new ones are read."""
        first = next((i for i, old in enumerate(self._samples) if old is samples[0]), None)
        known_count = 0 if first is None else len(self._samples) - first
        if first is None or self._samples[first:] != list(samples[:known_count]):
            self._trail = trail(samples, self._pose_of)
        elif first or known_count < len(samples):
            new = trail(samples[known_count:], self._pose_of)
            both = zip(astuple(self._trail), astuple(new), strict=True)
            self._trail = PoseTrail(*(np.concatenate((old[first:], more)) for old, more in both))
        self._samples = list(samples)
        return self._trail


def trail(samples: Sequence[Sample], pose_of: PoseOf) -> PoseTrail:
    """Return where samples were, in the fixed frame."""
    table = np.array([_row(sample, pose_of(sample.message)) for sample in samples]).reshape(-1, 14)
    ok = is_drawable(table[:, :3]) & np.isfinite(table[:, 3:7]).all(axis=1)
    table[~ok, :3] = 0.0
    with np.errstate(over="ignore", invalid="ignore"):
        squares = np.square(table[:, 3:7]).sum(axis=1)
    frame_wxyzs, _ = normalized(table[:, 10:])
    local_wxyzs, _ = normalized(table[:, 3:7])
    frames = matrices(frame_wxyzs)
    wxyzs = multiply_many(frame_wxyzs, local_wxyzs)
    positions = np.einsum("nij,nj->ni", frames, table[:, :3]) + table[:, 7:10]
    return PoseTrail(positions, matrices(wxyzs), wxyzs, frames, squares, ok)


def _row(sample: Sample, pose: messages.Pose) -> tuple[float, ...]:
    """Position and orientation in the message, then those of its frame in the fixed frame."""
    p, q = pose.position, pose.orientation
    return (p.x, p.y, p.z, q.w, q.x, q.y, q.z, *sample.pose.position, *sample.pose.wxyz)
