"""Points of a laser scan, from its ranges."""

from __future__ import annotations

import functools
import math

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz import Frames, Sample
from webviz.data import messages
from webviz.data.rotations import matrices
from webviz_displays.point_cloud2.decimation import evenly
from webviz_displays.shared.geometry import FARTHEST, is_drawable

F32 = NDArray[np.float32]
F64 = NDArray[np.float64]

MAX_ANGLE = 1000.0
"""Radians; float32 resolves 0.003 degrees there, and no laser turns that often."""

MAX_BEAMS = 100_000
"""Drawn of one scan, twenty times as many as any laser has; they take 25 ms of the frame loop."""


class BeamPoints(msgspec.Struct, frozen=True):
    """The beams of a scan that hit something.

    Args:
        beams: int (N,), index of each in the message.
        xyz: float32 (N, 3), metres in the frame of the scan.
        total: beams of the message.
        dropped: counts of the other beams by reason; reasons without beams are omitted.
    """

    beams: NDArray[np.intp]
    xyz: F32
    total: int
    dropped: dict[str, int]

    def sentence(self) -> str:
        """Return the number of points shown and the reasons why others are dropped."""
        text = f"Showing {len(self.beams)} of {self.total} points"
        if not self.dropped:
            return text + "."
        reasons = ", ".join(f"{count} {reason}" for reason, count in self.dropped.items())
        return f"{text}; dropped {self.total - len(self.beams)}: {reasons}."


def fault(scan: messages.LaserScan) -> str:
    """Return a sentence why no beam of a scan can be placed, "" if they can."""
    if not len(scan.ranges):
        return "The scan has no ranges. Check the laser driver."
    are_angles = abs(scan.angle_min) <= MAX_ANGLE and abs(scan.angle_increment) <= math.tau
    if are_angles and scan.range_min < scan.range_max:  # nearly always, and sooner known
        return ""
    for name in ("angle_min", "angle_increment", "range_min", "range_max"):
        value = getattr(scan, name)
        if math.isnan(value) or (name.startswith("angle") and math.isinf(value)):
            return f"{name} is {value}. The publisher must set it to a finite number."
    for name, most in (("angle_min", MAX_ANGLE), ("angle_increment", math.tau)):
        if abs(value := getattr(scan, name)) > most:
            return f"{name} is {value:g} rad; expected a number from {-most:g} to {most:g}."
    return (
        f"range_max ({scan.range_max:g} m) is not greater than range_min "
        f"({scan.range_min:g} m), so no range is valid. Fix them in the laser driver."
    )


def project(scan: messages.LaserScan) -> BeamPoints:
    """Return the points of a scan without `fault`, as seen from where it was at its stamp.

    The rules are those of laser_geometry: a range counts if range_min <= range < range_max, and
    beam i points at angle_min + i * angle_increment from x towards y.
    """
    ranges = scan.ranges
    nearest, farthest = max(scan.range_min, -FARTHEST), min(scan.range_max, FARTHEST)
    is_hit = (ranges >= nearest) & (ranges < farthest)  # of NaN, no comparison holds
    (beams,) = is_hit.nonzero()
    over = max(len(beams) - MAX_BEAMS, 0)
    if over:
        beams = beams[evenly(len(beams), MAX_BEAMS)]
    if len(ranges) <= MAX_BEAMS:  # so that few bytes are kept
        xyz = _directions(scan.angle_min, scan.angle_increment, len(ranges)).take(beams, axis=0)
    else:
        xyz = _unit_vectors(scan.angle_min + beams * scan.angle_increment)
    xyz *= ranges.take(beams)[:, None]
    dropped = {} if len(beams) == len(ranges) else _reasons(scan, ranges[~is_hit])
    if over:
        dropped[f"over the limit of {MAX_BEAMS}"] = over
    return BeamPoints(beams, xyz, len(ranges), dropped)


@functools.lru_cache(maxsize=8)
def _directions(angle_min: float, angle_increment: float, count: int) -> F32:
    """Return unit vectors (count, 3) of all beams; most lasers have the same in every scan."""
    return _unit_vectors(angle_min + np.arange(count) * angle_increment)


def _unit_vectors(angles: NDArray[np.floating]) -> F32:
    """Return unit vectors (N, 3) in the x-y plane at angles (N,) from x towards y, in rad."""
    vectors = np.zeros((len(angles), 3), np.float32)
    vectors[:, 0], vectors[:, 1] = np.cos(angles), np.sin(angles)
    return vectors


def _reasons(scan: messages.LaserScan, ranges: F32) -> dict[str, int]:
    """Return counts of the ranges (N,) of a scan that hit nothing, by reason."""
    finite = ranges[np.isfinite(ranges)]
    nan, near = int(np.isnan(ranges).sum()), int((finite < scan.range_min).sum())
    counts = {
        "NaN": nan,
        "infinite": len(ranges) - len(finite) - nan,
        f"nearer than range_min ({scan.range_min:g} m)": near,
        f"not nearer than range_max ({scan.range_max:g} m)": len(finite) - near,
    }
    return {reason: count for reason, count in counts.items() if count}


def deskew(points: BeamPoints, sample: Sample, frames: Frames) -> tuple[F32 | F64, int]:
    """Return the points as if all beams had been measured at the stamp of the scan.

    Each beam is placed in the fixed frame with the transform at its own time, stamp +
    i * time_increment. If it is missing, the transform of the nearest beam that has one is used.

    Args:
        points: of the scan in `sample`.
        sample: of a LaserScan with a stamp.
        frames: knows the fixed frame and the transforms.

    Returns:
        Points (N, 3) in the frame of the scan at its stamp, and the number of beams
        without a transform of their own.
    """
    ahead_ns = np.round(points.beams * (sample.message.time_increment * 1e9)).astype(np.int64)
    positions, wxyzs, is_known = frames.along(sample.frame, sample.stamp_ns + ahead_ns)
    is_known &= is_drawable(positions)
    missing = int(len(is_known) - is_known.sum())
    if missing == len(is_known):
        return points.xyz, missing
    if missing:
        has = np.flatnonzero(is_known)
        middles = (has[1:] + has[:-1] + 1) // 2
        nearest = has[np.searchsorted(middles, np.arange(len(is_known)), side="right")]
        positions, wxyzs = positions[nearest], wxyzs[nearest]
    fixed = np.einsum("nij,nj->ni", matrices(wxyzs), points.xyz) + positions
    return (fixed - sample.pose.position) @ matrices(sample.pose.wxyz), missing
