"""Alignment of a laser scan with a map: the mounting with which most points lie on walls.

The scan is moved in the plane of the map: by x, y and a turn about the laser. Its cost is the mean
of the squared distances of its points to the nearest occupied cell, each at most `FAR_M`, so that
what the map does not know has no pull. A search on a coarse grid finds where to begin, and
Gauss-Newton steps on the field of distances end it, as in scan matchers such as Hector SLAM (S.
Kohlbrecher et al., "A flexible and scalable SLAM system with full 3D motion estimation", 2011).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

F64 = NDArray[np.float64]
C128 = NDArray[np.complex128]

FAR_M = 0.6
"""Distance from which on a point counts as beside every wall."""
COARSE_POINTS = 80
STEP_M, REACH_M = 0.3, 1.2
TURN_RAD = math.radians(5.0)
BEGINNINGS = 12
"""Best places of the grid that are refined."""
STEPS = 25
CLOSE = 1e-6
"""Metres and radians of a step that ends the search."""
NEAR_AS_GOOD = 1.1
"""Ratio of costs within which the smaller change is taken."""


class Correction(NamedTuple):
    """A correction of a mounting.

    Args:
        shift: of the laser in metres along the map's axes, x + iy.
        turn: about the laser in radians, counter-clockwise.
        cost: mean square of the distances afterwards, in square metres.
    """

    shift: complex
    turn: float
    cost: float


def distances(occupied: NDArray[np.bool_], resolution: float) -> F64:
    """Return the distance of each cell to the nearest occupied one, centre to centre.

    Args:
        occupied: bool (rows, columns).
        resolution: edge of a cell in metres.

    Returns:
        float64 (rows, columns), metres.
    """
    reach = math.ceil(FAR_M / resolution)
    columns = np.arange(occupied.shape[1], dtype=np.float64)
    nowhere = math.inf
    before = np.maximum.accumulate(np.where(occupied, columns, -nowhere), axis=1)
    after = np.minimum.accumulate(np.where(occupied, columns, nowhere)[:, ::-1], axis=1)[:, ::-1]
    along = np.minimum(np.minimum(columns - before, after - columns), reach) ** 2
    nearest = along.copy()
    for by in range(1, min(reach, len(along) - 1) + 1):
        np.minimum(nearest[by:], along[:-by] + by * by, out=nearest[by:])
        np.minimum(nearest[:-by], along[by:] + by * by, out=nearest[:-by])
    return np.minimum(np.sqrt(nearest) * resolution, FAR_M)


def align(field: F64, resolution: float, here: complex, points: C128) -> Correction:
    """Find the correction with which the points of a scan lie on walls best.

    Args:
        field: of `distances`.
        resolution: edge of a cell in metres.
        here: position of the laser in metres from the corner of the field, x + iy.
        points: (N,), the points of the scan relative to the laser, in the axes of the map.
    """
    coarse = points[:: max(1, len(points) // COARSE_POINTS)]
    refined = [
        _refined(field, resolution, here, points, *each)
        for each in _beginnings(field, resolution, here, coarse)
    ]
    least = min(each.cost for each in refined) * NEAR_AS_GOOD + 1e-9
    return min((each for each in refined if each.cost <= least), key=_size)


def _size(correction: Correction) -> float:
    return abs(correction.shift) + abs(correction.turn)


def _beginnings(
    field: F64, resolution: float, here: complex, points: C128
) -> Iterator[tuple[complex, float]]:
    """Yield the best places of a grid around the laser, and the present one."""
    yield 0j, 0.0
    line = np.arange(-REACH_M, REACH_M + STEP_M / 2, STEP_M)
    shifts = (line + 1j * line[:, None]).ravel()
    turns = np.arange(-math.pi, math.pi, TURN_RAD)
    costs = np.empty((len(turns), len(shifts)))
    for row, turn in enumerate(turns):
        places = here + shifts[:, None] + points * np.exp(1j * turn)
        costs[row] = (_nearest(field, resolution, places) ** 2).mean(axis=1)
    for place in np.argsort(costs, axis=None)[:BEGINNINGS]:
        row, column = divmod(int(place), len(shifts))
        yield complex(shifts[column]), float(turns[row])


def _nearest(field: F64, resolution: float, places: C128) -> F64:
    """Return the distances at places, without interpolation."""
    rows, columns = field.shape
    x = np.floor(places.real / resolution).astype(np.intp)
    y = np.floor(places.imag / resolution).astype(np.intp)
    inside = (x >= 0) & (y >= 0) & (x < columns) & (y < rows)
    return np.where(inside, field[np.where(inside, y, 0), np.where(inside, x, 0)], FAR_M)


def _refined(
    field: F64, resolution: float, here: complex, points: C128, shift: complex, turn: float
) -> Correction:
    """Follow Gauss-Newton steps to the nearest minimum."""
    best = Correction(shift, turn, math.inf)
    for _ in range(STEPS):
        turned = points * np.exp(1j * turn)
        value, slope = _sampled(field, resolution, here + shift + turned)
        cost = float((value**2).mean())
        if cost >= best.cost:
            break
        best = Correction(shift, math.remainder(turn, math.tau), cost)
        near = value < FAR_M
        if near.sum() < 3:
            break
        x, y = slope.real[near], slope.imag[near]
        about = y * turned.real[near] - x * turned.imag[near]
        jacobian = np.column_stack((x, y, about))
        normal = jacobian.T @ jacobian + np.diag((1e-3, 1e-3, 1e-3))
        step = np.linalg.solve(normal, -jacobian.T @ value[near])
        shift += complex(step[0], step[1])
        turn += float(step[2])
        if np.abs(step).max() < CLOSE:
            break
    return best


def _sampled(field: F64, resolution: float, places: C128) -> tuple[F64, C128]:
    """Return the distances at places and their slopes along x and y, interpolated bilinearly."""
    rows, columns = field.shape
    x, y = places.real / resolution - 0.5, places.imag / resolution - 0.5
    inside = (x >= 0) & (y >= 0) & (x < columns - 1) & (y < rows - 1)
    x, y = np.where(inside, x, 0.0), np.where(inside, y, 0.0)
    column, row = np.floor(x).astype(np.intp), np.floor(y).astype(np.intp)
    u, v = x - column, y - row
    a, b = field[row, column], field[row, column + 1]
    c, d = field[row + 1, column], field[row + 1, column + 1]
    value = (a * (1 - u) + b * u) * (1 - v) + (c * (1 - u) + d * u) * v
    slope_x = ((b - a) * (1 - v) + (d - c) * v) / resolution
    slope_y = ((c - a) * (1 - u) + (d - b) * u) / resolution
    return np.where(inside, value, FAR_M), np.where(inside, slope_x + 1j * slope_y, 0.0)
