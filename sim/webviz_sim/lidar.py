"""The laser scanner."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from webviz_sim.circles import NONE, Circles, cast
from webviz_sim.pose import Pose2D
from webviz_sim.world import World

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
        crossings = _first_crossing(grid, start, other, along, across, limit)
        nearer = crossings < distances
        distances[nearer] = crossings[nearer]
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


@dataclass
class LidarSettings:
    """Properties of a scanner."""

    beams: int = 360
    """Beams of one revolution; the first looks backwards (-pi), the others follow to the left."""
    range_min: float = 0.12
    range_max: float = 10.0
    """Distances in metres outside of which nothing is measured."""
    noise: float = 0.01
    """Standard deviation of a range in metres."""


class Scan(NamedTuple):
    """One revolution, as in sensor_msgs/LaserScan."""

    ranges: NDArray[np.float32]
    """Shape (beams,), metres; infinite if nothing is within range (REP 117)."""
    intensities: NDArray[np.float32]
    """Shape (beams,), 0 to 100."""


def scan(
    world: World,
    first: Pose2D,
    last: Pose2D,
    settings: LidarSettings,
    random: np.random.Generator,
    circles: Circles = NONE,
) -> Scan:
    """Measures one revolution.

    Args:
        world: The world to scan.
        first: The scanner in the map frame at the first beam.
        last: The scanner one revolution later; in between it moves steadily.
        settings: The scanner.
        random: Source of the noise.
        circles: Obstacles that are not in the world.
    """
    fractions = np.arange(settings.beams) / settings.beams
    start, end = world.to_grid(first), world.to_grid(last)
    turned = math.remainder(end.yaw - start.yaw, math.tau)
    x = start.x + fractions * (end.x - start.x)
    y = start.y + fractions * (end.y - start.y)
    angles = start.yaw + fractions * turned - math.pi + math.tau * fractions
    reach = settings.range_max / world.resolution
    distances, incidence = cast_rays(world.occupied, x, y, angles, reach)
    if len(circles):
        centres = world.to_cells(circles[:, :2])
        scaled = np.column_stack([centres, circles[:, 2] / world.resolution])
        met = cast(scaled, x, y, angles)
        incidence[met < distances] = 1.0
        distances = np.minimum(distances, met)
    ranges = distances * world.resolution
    # A matt surface returns less of a beam that is flat or comes from far away.
    intensities = 100.0 * incidence / (1.0 + (ranges / 4.0) ** 2)
    ranges = ranges + settings.noise * random.standard_normal(settings.beams)
    ranges[(ranges < settings.range_min) | (ranges > settings.range_max)] = np.inf
    intensities[np.isinf(ranges)] = 0.0
    return Scan(ranges.astype(np.float32), intensities.astype(np.float32))
