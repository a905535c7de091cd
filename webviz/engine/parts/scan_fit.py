"""Fit of laser scans to a map, the correction that improves it, and obstacles on paths."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from webviz.api.consistency import GOOD, Fit

F64 = NDArray[np.float64]
C128 = NDArray[np.complex128]

POINTS = 200
"""Most points that are compared; more are thinned out evenly."""
FEWEST = 40
"""Fewer points on known ground say nothing."""
NEAR_M = 1.0
"""Nearer points are no landmark: they fit any wall, or belong to the robot and to people."""
TOLERANCE_M = 0.2
"""Distance to the next occupied cell within which a point lies on a wall."""
OCCUPIED = 65
"""Value of a cell from which on it is occupied (map_server's occupied_thresh)."""
REACH_CELLS = 300
"""Cells around the laser, in each direction, within which points are compared."""
SHIFT_M = 3.0
"""Radius of the search for a better place."""

WIDTH_M = 0.1
"""Distance from a path within which a point is in the way of any robot."""
AROUND_M = 0.4
"""Distance from the laser and from the end of a path within which nothing is in the way."""
MAX_STEPS = 1000
"""Places along a path that are looked at."""

CURED, BETTER = 0.85, 0.25
"""Share of points on walls that a cure must reach, and how much larger it must be."""
EQUAL = 0.03
"""Shares that differ by less are equal."""


def _square(reach: float, step: float) -> C128:
    """Shifts (N,) in metres, x + iy, as far as `reach` along both axes."""
    line = np.arange(-reach, reach + step / 2, step)
    return (line + 1j * line[:, None]).ravel()


_TURNS = np.radians(np.arange(-180.0, 180.0, 3.0)).astype(np.complex128)
_FINE_TURNS = np.radians(np.arange(-6.0, 6.25, 0.5)).astype(np.complex128)
_SHIFTS = _square(SHIFT_M, TOLERANCE_M)
_FINE_SHIFTS = _square(0.3, 0.05)


def fit(
    laser: complex,
    heading: float,
    points: C128,
    resolution: float,
    window: Callable[[int, int, int, int], NDArray[np.int8]],
) -> Fit | None:
    """Compare a scan with a map, None if too little of the map is known there.

    Args:
        laser: position of the laser in metres in the coordinates of the map, x + iy.
        heading: direction of the laser's x axis there, in radians.
        points: (N,), the points of the scan relative to the laser, likewise.
        resolution: edge of a cell in metres.
        window: see `webviz.api.consistency.OccupiedCells`.
    """
    reach = min(REACH_CELLS, math.ceil((np.abs(points).max(initial=0.0) + SHIFT_M) / resolution))
    distances = np.abs(points)
    points = points[(distances > NEAR_M) & (distances < reach * resolution)]
    points = thinned(points, POINTS)
    if len(points) < FEWEST:
        return None
    column, row = math.floor(laser.real / resolution), math.floor(laser.imag / resolution)
    corner = complex(column - reach, row - reach) * resolution
    cells = window(row - reach, column - reach, 2 * reach, 2 * reach)
    walls = _widened(cells >= OCCUPIED, min(math.ceil(TOLERANCE_M / resolution), reach))
    here = laser - corner

    def at(grid: NDArray[np.bool_], places: C128) -> NDArray[np.bool_]:
        """Return the cells at places relative to the corner; those outside are False."""
        x = np.floor(places.real / resolution).astype(np.intp)
        y = np.floor(places.imag / resolution).astype(np.intp)
        inside = (x >= 0) & (y >= 0) & (x < 2 * reach) & (y < 2 * reach)
        return inside & grid[np.where(inside, y, 0), np.where(inside, x, 0)]

    on_walls = at(walls, here + points)
    judged = on_walls | at(cells >= 0, here + points)
    count = int(judged.sum())
    if count < FEWEST:
        return None
    share = float(on_walls.sum()) / count
    if share >= GOOD:
        return Fit(share, count)
    points = points[judged]

    def shares(grid: NDArray[np.bool_], places: C128) -> F64:
        return at(grid, places).mean(axis=-1)

    def turned(angles: C128) -> C128:
        return here + points * np.exp(1j * angles)[:, None]

    def shifted(shifts: C128) -> C128:
        return here + shifts[:, None] + points

    turns, shifts = _TURNS, _SHIFTS
    of_turns, of_shifts = shares(walls, turned(turns)), shares(walls, shifted(shifts))
    mirrored = float(shares(walls, here + points.conj() * np.exp(2j * heading)))
    by_turn, by_shift = float(of_turns.max()), float(of_shifts.max())
    best = max(by_turn, by_shift, mirrored)
    if best < max(CURED, share + BETTER):
        return Fit(share, count)
    if mirrored >= best - EQUAL and by_turn < best - EQUAL:
        return Fit(share, count, is_mirrored=True, cured=mirrored)
    narrow = _widened(cells >= OCCUPIED, 1)
    if by_turn >= best - EQUAL:
        near = _middle(turns, of_turns) + _FINE_TURNS
        turn = near[shares(narrow, turned(near)).argmax()].real
        return Fit(share, count, turn=float(turn), cured=by_turn)
    near = _middle(shifts, of_shifts) + _FINE_SHIFTS
    shift = near[shares(narrow, shifted(near)).argmax()]
    return Fit(share, count, shift=(float(shift.real), float(shift.imag)), cured=by_shift)


def in_the_way(laser: complex, points: C128, way: C128) -> int:
    """Return the number of points of a scan on a path, where the robot would hit them.

    Those on the robot itself and around the end of the path, where it may stop, do not count.

    Args:
        laser: position of the laser in metres, x + iy.
        points: (N,), the points of the scan relative to the laser.
        way: (M,), the path, likewise in the coordinates of `laser`.
    """
    lengths = np.concatenate([[0.0], np.abs(np.diff(way)).cumsum()])
    most = float(lengths[-1]) - AROUND_M
    if most <= 0.0:
        return 0
    steps = np.linspace(0.0, most, min(MAX_STEPS, math.ceil(most / WIDTH_M) + 1))
    line = np.interp(steps, lengths, way)
    points = laser + points[np.abs(points) > AROUND_M]
    points = points[np.abs(points - way[-1]) > AROUND_M]
    beside = np.maximum(line.real.min() - points.real, points.real - line.real.max())
    ahead = np.maximum(line.imag.min() - points.imag, points.imag - line.imag.max())
    points = thinned(points[(beside < WIDTH_M) & (ahead < WIDTH_M)], POINTS)
    return int((np.abs(points[:, None] - line).min(axis=1, initial=math.inf) < WIDTH_M).sum())


def thinned(points: C128, most: int) -> C128:
    """Return at most that many of the points, evenly picked."""
    if len(points) <= most:
        return points
    return points[np.linspace(0, len(points) - 1, most).astype(int)]


def _middle(values: C128, shares: F64) -> complex:
    """Return the mean of the best values around the one with the smallest size."""
    best = values[shares >= shares.max() - EQUAL]
    nearest = best[np.argmin(np.abs(best))]
    step = np.abs(values[1] - values[0])
    return complex(best[np.abs(best - nearest) < 4 * step].mean())


def _widened(cells: NDArray[np.bool_], by: int) -> NDArray[np.bool_]:
    """Return the cells that have a true one at most `by` rows and columns away."""
    sums = np.zeros(np.add(cells.shape, 2 * by + 1), np.int32)
    inner = sums[by + 1 : by + 1 + cells.shape[0], by + 1 : by + 1 + cells.shape[1]]
    inner[...] = cells
    sums = sums.cumsum(axis=0, out=sums).cumsum(axis=1)
    size = 2 * by + 1
    rows, columns = cells.shape
    # sums[i, j] counts the cells above and left of row i and column j of the padded grid.
    low, high = np.s_[:rows], np.s_[size : size + rows]
    left, right = np.s_[:columns], np.s_[size : size + columns]
    count = sums[high, right] - sums[low, right] - sums[high, left] + sums[low, left]
    return count > 0
