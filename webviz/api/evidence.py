"""Inputs of the consistency check between displays.

A laser scan that lies beside the walls of the map, or a path that leads through what the scan sees,
is a fault that no display finds alone. A display returns one of these from `Display.evidence`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from webviz.api.nodes import Pose


@dataclass(frozen=True, eq=False)
class Hits:
    """Where a sensor hit something.

    Args:
        frame: frame id of the sensor, which is at its origin.
        stamp_ns: of the measurement.
        xyz: float64 (N, 3), metres in `frame`.
    """

    frame: str
    stamp_ns: int
    xyz: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Walls:
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
class Way:
    """Where a robot is about to drive.

    Args:
        frame: frame id of the poses.
        received_ns: ROS time of its arrival.
        xyz: float64 (N, 3), at least two poses in metres.
    """

    frame: str
    received_ns: int
    xyz: NDArray[np.float64]


Evidence = Hits | Walls | Way
