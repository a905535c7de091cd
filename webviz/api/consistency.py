"""Inputs of the consistency check between displays.

A laser scan that lies beside the walls of the map, or a path that leads through what the scan sees,
is a fault that no display finds alone. A display returns one of these from
`Comparable.consistency_input`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from webviz.api.nodes import Pose

GOOD = 0.8
"""Share of points on walls from which on a scan fits."""
BAD = 0.4
"""Share of points on walls below which a scan does not fit, even if nothing else does."""


@dataclass(frozen=True, eq=False)
class ScanPoints:
    """Points at which a sensor hit something.

    Args:
        frame: frame id of the sensor, which is at its origin.
        stamp_ns: of the measurement.
        xyz: float64 (N, 3), metres in `frame`.
    """

    frame: str
    stamp_ns: int
    xyz: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class OccupiedCells:
    """Occupied cells of a map.

    Args:
        topic: of the map.
        frame: frame id that `origin` is given in.
        origin: of the corner of cell (0, 0); columns run along its x, rows along its y.
        resolution: edge of a cell in metres.
        window: the cells from a row and column on, as many as asked for, int8 (rows, columns):
            0 is free and 100 occupied; unknown cells and those beyond the map are -1.
    """

    topic: str
    frame: str
    origin: Pose
    resolution: float
    window: Callable[[int, int, int, int], NDArray[np.int8]]


@dataclass(frozen=True, eq=False)
class RobotPath:
    """Path that a robot is about to drive.

    Args:
        frame: frame id of the poses.
        received_ns: ROS time of its arrival.
        xyz: float64 (N, 3), at least two poses in metres.
    """

    frame: str
    received_ns: int
    xyz: NDArray[np.float64]


ConsistencyInput = ScanPoints | OccupiedCells | RobotPath


@dataclass(frozen=True)
class Fit:
    """Quality of the fit of a scan.

    Args:
        share: of `points` that lie on walls.
        points: that were compared, those on known ground.
        turn: rotation about the laser in radians that would make it fit, None if none would.
        shift: of the laser in metres along the map's axes that would, None if none would.
        is_mirrored: whether a laser mounted upside down would fit.
        cured: the share of points on walls with that.
    """

    share: float
    points: int
    turn: float | None = None
    shift: tuple[float, float] | None = None
    is_mirrored: bool = False
    cured: float = 0.0

    @property
    def is_cured(self) -> bool:
        """Return whether something would make it fit."""
        return self.is_mirrored or self.turn is not None or self.shift is not None

    @property
    def is_good(self) -> bool:
        """Return whether the scan belongs where it is, as far as can be known."""
        return self.share >= GOOD or (self.share >= BAD and not self.is_cured)


@dataclass(frozen=True)
class MapFit:
    """Fit of the scan of one display to the map that fits best.

    Args:
        fit: its quality.
        frame: frame id of the sensor.
        map_topic: topic of the map.
        map_frame: frame id of the map.
        is_placed: whether another scan shows that the robot is in place.
    """

    fit: Fit
    frame: str
    map_topic: str
    map_frame: str
    is_placed: bool

    @property
    def proof(self) -> str:
        """A sentence with the share of points on walls, as it is and as it would be."""
        fit = self.fit
        cure = ""
        if fit.turn is not None:
            cure = f"turned by {math.degrees(fit.turn):.0f}°"
        elif fit.shift is not None:
            x, y = fit.shift
            cure = f"moved by ({x:.1f}, {y:.1f}) m"
        elif fit.is_mirrored:
            cure = "mirrored"
        now = f"{fit.share:.0%} of its points lie on walls of {self.map_topic}"
        return f"{now}; {cure}, {fit.cured:.0%} would." if cure else f"{now}."
