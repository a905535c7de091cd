"""Odometry messages as arrays, and checks of their poses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from math import dist, isfinite

import numpy as np
from numpy.typing import NDArray

from webviz import Sample
from webviz.data import messages
from webviz.data.rotations import angle_between, matrices, multiply_many, normalized
from webviz_displays.odometry.covariance import LARGEST
from webviz_displays.shared.geometry import FARTHEST

F64 = NDArray[np.float64]

UNIT_TOLERANCE = 0.01
"""How far the squared length of a quaternion may be from 1 (RViz's constant)."""


@dataclass(frozen=True)
class Trail:
    """Poses of N samples in the fixed frame.

    Args:
        positions: (N, 3), metres.
        rotations: (N, 3, 3), of the robot.
        wxyzs: (N, 4), the same.
        frames: (N, 3, 3), rotations of the frames in which the messages give them.
    """

    positions: F64
    rotations: F64
    wxyzs: F64
    frames: F64


def fault(message: messages.Odometry) -> str:
    """A sentence why a pose cannot be drawn, "" if it can."""
    p, q = message.pose.pose.position, message.pose.pose.orientation
    if not all(map(isfinite, (p.x, p.y, p.z, q.x, q.y, q.z, q.w))):
        return (
            f"The pose is not finite: position ({p.x:g}, {p.y:g}, {p.z:g}), "
            f"orientation ({q.x:g}, {q.y:g}, {q.z:g}, {q.w:g})."
        )
    if max(abs(p.x), abs(p.y), abs(p.z)) >= FARTHEST:
        return f"The position ({p.x:g}, {p.y:g}, {p.z:g}) is too far away to be drawn."
    square = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w
    if square == 0.0:
        return "The orientation is all zeros. The publisher must set it (w = 1 for no rotation)."
    if abs(square - 1.0) >= UNIT_TOLERANCE:
        return (
            f"The orientation ({q.x:g}, {q.y:g}, {q.z:g}, {q.w:g}) is not normalized: "
            f"its squared length is {square:g} instead of 1."
        )
    return ""


def has_moved(
    new: messages.Odometry, last: messages.Odometry, distance: float, angle: float
) -> bool:
    """Whether a pose is at least this far (m) or turned this much (rad) from the last one."""
    a, b = new.pose.pose, last.pose.pose
    p, q = a.position, b.position
    if dist((p.x, p.y, p.z), (q.x, q.y, q.z)) >= distance:
        return True
    p, q = a.orientation, b.orientation
    return angle_between((p.w, p.x, p.y, p.z), (q.w, q.x, q.y, q.z)) >= angle


def is_sound(message: messages.Odometry) -> bool:
    """Whether the covariance of a pose is finite, of a sensible size and nowhere negative."""
    entries = message.pose.covariance
    return bool(np.abs(entries).max() <= LARGEST and entries[::7].min() >= 0)


class GrowingTrail:
    """Trails of a list of samples that grows at its end and shrinks at its start."""

    def __init__(self) -> None:
        self._samples: list[Sample] = []
        self._trail = trail([])

    def of(self, samples: Sequence[Sample]) -> Trail:
        """`trail` of these samples; only new ones are read."""
        first = next((i for i, old in enumerate(self._samples) if old is samples[0]), None)
        known = 0 if first is None else len(self._samples) - first
        if first is None or self._samples[first:] != list(samples[:known]):
            self._trail = trail(samples)
        elif first or known < len(samples):
            new = trail(samples[known:])
            self._trail = Trail(
                *(
                    np.concatenate((getattr(self._trail, f.name)[first:], getattr(new, f.name)))
                    for f in fields(Trail)
                )
            )
        self._samples = list(samples)
        return self._trail


def trail(samples: Sequence[Sample]) -> Trail:
    """Where samples without `fault` were, in the fixed frame."""
    table = np.array([_row(sample) for sample in samples]).reshape(-1, 14)
    frame_wxyzs, _ = normalized(table[:, 10:])
    local_wxyzs, _ = normalized(table[:, 3:7])
    frames = matrices(frame_wxyzs)
    wxyzs = multiply_many(frame_wxyzs, local_wxyzs)
    positions = np.einsum("nij,nj->ni", frames, table[:, :3]) + table[:, 7:10]
    return Trail(positions, matrices(wxyzs), wxyzs, frames)


def _row(sample: Sample) -> tuple[float, ...]:
    """Position and orientation in the message, then those of its frame in the fixed frame."""
    pose = sample.message.pose.pose
    p, q = pose.position, pose.orientation
    return (p.x, p.y, p.z, q.w, q.x, q.y, q.z, *sample.pose.position, *sample.pose.wxyz)
