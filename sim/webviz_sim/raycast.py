"""Where rays meet the first occupied cell of a grid, for all rays at once."""

import numpy as np
from numpy.typing import NDArray

_CHUNK = 48  # grid lines per pass, 2.4 m at 0.05 m: about as far as indoor beams reach


def cast_rays(
    occupied: NDArray[np.bool_],
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    angles: NDArray[np.float64],
    reach: float,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Casts rays and returns the exact length of each.

    A ray changes cells only where it crosses a grid line, so its hit is the first crossing into an
    occupied cell (Amanatides and Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing", 1987).
    Here crossings are computed in chunks for all rays. The outside of the grid is free.

    Args:
        occupied: Shape (height, width), indexed [row, column].
        x: Shape (n,), start of each ray along the columns, in cells.
        y: Shape (n,), start of each ray along the rows, in cells.
        angles: Shape (n,), direction of each ray in radians from the x axis.
        reach: Maximum length, in cells.

    Returns:
        Two arrays of shape (n,): the distance to the hit in cells, infinite if there is none
        within reach; and the cosine of the angle between the ray and the normal of the cell face
        it hit, 1 if there is no hit or the ray starts inside an occupied cell.
    """
    dx, dy = np.cos(angles), np.sin(angles)
    distances = np.full(len(angles), np.inf)
    distances[_lookup(occupied, np.floor(y), np.floor(x))] = 0.0
    incidence = np.ones(len(angles))
    for grid, start, other, along, across in ((occupied, x, y, dx, dy), (occupied.T, y, x, dy, dx)):
        limit = np.minimum(distances, reach)
        found = _first_crossing(grid, start, other, along, across, limit)
        nearer = found < distances
        distances[nearer] = found[nearer]
        incidence[nearer] = np.abs(along[nearer])
    return distances, incidence


def _first_crossing(
    occupied: NDArray[np.bool_],
    start: NDArray[np.float64],
    other: NDArray[np.float64],
    along: NDArray[np.float64],
    across: NDArray[np.float64],
    limit: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Distances at which rays enter an occupied cell through one family of parallel grid lines.

    Args:
        occupied: Indexed [other, start].
        start: Shape (n,), coordinate perpendicular to the grid lines.
        other: Shape (n,), coordinate along them.
        along: Shape (n,), the direction's component perpendicular to the grid lines.
        across: Shape (n,), its component along them.
        limit: Shape (n,), maximum length of each ray.

    Returns:
        Shape (n,), infinite if nothing is hit within the limit.
    """
    distances = np.full(len(start), np.inf)
    sign = np.where(along < 0, -1.0, 1.0)
    first = np.where(along < 0, np.ceil(start) - 1.0, np.floor(start) + 1.0)
    active = np.flatnonzero(np.abs(first - start) < np.abs(along) * limit)
    steps = np.arange(_CHUNK)
    while len(active):
        lines = first[active, None] + sign[active, None] * steps
        reached = (lines - start[active, None]) / along[active, None]
        entered = np.where(sign[active, None] < 0, lines - 1.0, lines)
        rows = np.floor(other[active, None] + reached * across[active, None])
        hit = _lookup(occupied, rows, entered) & (reached <= limit[active, None])
        index = hit.argmax(axis=1)
        each = np.arange(len(active))
        is_hit = hit[each, index]
        distances[active[is_hit]] = reached[each, index][is_hit]
        first[active] += sign[active] * _CHUNK
        active = active[~is_hit & (reached[:, -1] < limit[active])]
    return distances


def _lookup(
    occupied: NDArray[np.bool_], rows: NDArray[np.float64], columns: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """Return whether cells are occupied; those outside the grid are not."""
    height, width = occupied.shape
    inside = (rows >= 0) & (rows < height) & (columns >= 0) & (columns < width)
    index = np.where(inside, rows, 0).astype(np.intp), np.where(inside, columns, 0).astype(np.intp)
    return occupied[index] & inside
