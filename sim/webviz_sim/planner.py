"""Paths around walls: A* on a grid of clearances, then smoothing."""

import heapq
import math

import numpy as np
from numpy.typing import NDArray

from webviz_sim.circles import NONE, Circles
from webviz_sim.pose import Pose2D
from webviz_sim.robot import RADIUS
from webviz_sim.world import World

MARGIN = 0.08  # m, minimum distance between the robot and a wall
COMFORT = 0.55  # m of clearance beyond which more is not worth a detour
CELL = 0.1  # m, edge of a planning cell, unless the world's cells are larger
SPACING = 0.05  # m between the points of a path

_STEPS = [
    (row, column, math.hypot(row, column))
    for row in (-1, 0, 1)
    for column in (-1, 0, 1)
    if (row, column) != (0, 0)
]

Cell = tuple[int, int]
"""Row and column in the planning grid."""


class Planner:
    """Plans in one world."""

    def __init__(self, world: World) -> None:
        self._world = world
        self._stride = max(1, round(CELL / world.resolution))
        reach = math.ceil(COMFORT / world.resolution) + 1
        self._distance = obstacle_distance(~world.traversable, reach) * world.resolution
        self._offset = self._stride // 2
        coarse = slice(self._offset, None, self._stride)
        self._clearance = self._distance[coarse, coarse]
        self._open = self._clearance >= RADIUS + MARGIN
        # From 1 in the open to 4 beside a wall, for each metre of the way.
        near = (COMFORT - self._clearance) / (COMFORT - RADIUS - MARGIN)
        self._cost = 1.0 + 3.0 * np.clip(near, 0.0, 1.0)

    def plan(
        self, start: Pose2D, goal: Pose2D, circles: Circles = NONE
    ) -> NDArray[np.float64] | None:
        """Plans a path that keeps clear of walls, unknown space and round obstacles.

        Args:
            start: In the map frame. If the robot has no clearance there, the path begins at the
                nearest place with clearance.
            goal: In the map frame; likewise. The yaw is ignored.
            circles: Obstacles that are not in the world.

        Returns:
            Points of the path in the map frame, shape (n, 2), about `SPACING` apart; None without
            a path.
        """
        is_open = self._open & self._is_beside(circles)
        source, target = (self._nearest(is_open, pose) for pose in (start, goal))
        if source is None or target is None:
            return None
        came_from = self._search(source, target, np.where(is_open, self._cost, np.inf))
        if target not in came_from:
            return None
        cells = [target]
        while cells[-1] != source:
            cells.append(came_from[cells[-1]])
        points = self._to_map(np.array(cells[::-1], dtype=float))
        for end, pose in ((0, start), (-1, goal)):
            if self._has_clearance(np.array([[pose.x, pose.y]]), circles)[0]:
                points[end] = pose.x, pose.y
        return self._smooth(_resample(points), circles)

    def spread(self, start: Pose2D, count: int) -> list[Pose2D]:
        """Chooses places to visit: reachable, with room around them, and far apart.

        Each place is the farthest from all previous ones (farthest-point sampling).

        Args:
            start: In the map frame.
            count: Maximum number of places.
        """
        source = self._nearest(self._open, start)
        if source is None:
            return []
        places = self._roomy(np.argwhere(self._reachable(source)))
        nearest = np.hypot(*(places - (start.x, start.y)).T)
        chosen = []
        while len(chosen) < count and nearest.max() > 2.0 * RADIUS:
            place = places[nearest.argmax()]
            chosen.append(Pose2D(float(place[0]), float(place[1])))
            nearest = np.minimum(nearest, np.hypot(*(places - place).T))
        return chosen

    def roomy_pose(self) -> Pose2D | None:
        """Return a place with room around it near the middle of the free space.

        None without any.
        """
        cells = np.argwhere(self._open)
        if not len(cells):
            return None
        places = self._roomy(cells)
        middle = self._to_map(cells.astype(float)).mean(axis=0)
        x, y = places[np.hypot(*(places - middle).T).argmin()]
        return Pose2D(float(x), float(y))

    def _roomy(self, cells: NDArray[np.intp]) -> NDArray[np.float64]:
        """Return the cells with at least the usual room around them, in the map frame."""
        clearance = self._clearance[tuple(cells.T)]
        return self._to_map(cells[clearance >= min(COMFORT, np.median(clearance))].astype(float))

    def _reachable(self, source: Cell) -> NDArray[np.bool_]:
        """Return the open cells that can be reached from a cell."""
        reached = np.zeros_like(self._open)
        reached[source] = True
        count = 0
        while count < (count := np.count_nonzero(reached)):
            for _ in range(16):  # counting takes as long as growing
                wide = reached.copy()
                wide[1:] |= reached[:-1]
                wide[:-1] |= reached[1:]
                reached = wide.copy()
                reached[:, 1:] |= wide[:, :-1]
                reached[:, :-1] |= wide[:, 1:]
                reached &= self._open
        return reached

    def _search(self, source: Cell, target: Cell, costs: NDArray[np.float64]) -> dict[Cell, Cell]:
        """Return a* from one cell to another; maps each visited cell to its predecessor.

        Args:
            source: The first cell.
            target: The last one.
            costs: Of each cell, for each cell's length of the way; infinite where there is none.
        """
        # Lists are faster for single cells. The index -1 leads to the border, as all outside does.
        factors = np.pad(costs, (0, 1), constant_values=np.inf).tolist()
        came_from = {source: source}
        lengths = {source: 0.0}
        queue = [(0.0, source)]
        visited = set()
        while queue:
            _, cell = heapq.heappop(queue)
            if cell == target:
                break
            if cell in visited:
                continue
            visited.add(cell)
            row, column = cell
            here = lengths[cell]
            for rows, columns, step in _STEPS:
                length = here + step * factors[row + rows][column + columns]
                other = (row + rows, column + columns)
                if length < lengths.get(other, math.inf):
                    lengths[other] = length
                    came_from[other] = cell
                    heapq.heappush(queue, (length + math.dist(other, target), other))
        return came_from

    def _nearest(self, is_open: NDArray[np.bool_], pose: Pose2D) -> Cell | None:
        """Return the open cell that is nearest to a pose; None without any."""
        x, y, _ = self._world.to_grid(pose)
        cells = np.argwhere(is_open)
        if not len(cells):
            return None
        here = (np.array([y, x]) - self._offset - 0.5) / self._stride
        row, column = cells[np.hypot(*(cells - here).T).argmin()]
        return int(row), int(column)

    def _is_beside(self, circles: Circles) -> NDArray[np.bool_]:
        """Return the planning cells (like `_open`) at whose centres the robot touches no circle."""
        height, width = self._open.shape
        is_beside = np.ones((height, width), dtype=bool)
        at = self._world.to_cells(circles[:, :2])
        columns, rows = ((at - self._offset - 0.5) / self._stride).T
        reaches = (circles[:, 2] + RADIUS + MARGIN) / (self._stride * self._world.resolution)
        for column, row, reach in zip(columns, rows, reaches, strict=True):
            y, x = np.ogrid[:height, :width]
            is_beside &= (x - column) ** 2 + (y - row) ** 2 >= reach**2
        return is_beside

    def _to_map(self, cells: NDArray[np.float64]) -> NDArray[np.float64]:
        """Centres of planning cells (row, column) in the map frame (x, y)."""
        return self._world.to_map(cells[:, ::-1] * self._stride + self._offset + 0.5)

    def _has_clearance(self, points: NDArray[np.float64], circles: Circles) -> NDArray[np.bool_]:
        height, width = self._distance.shape
        columns, rows = np.floor(self._world.to_cells(points)).astype(int).T
        inside = (rows >= 0) & (rows < height) & (columns >= 0) & (columns < width)
        index = np.where(inside, rows, 0), np.where(inside, columns, 0)
        clear = inside & (self._distance[index] >= RADIUS + MARGIN)
        for x, y, radius in circles:
            clear &= np.hypot(points[:, 0] - x, points[:, 1] - y) >= radius + RADIUS + MARGIN
        return clear

    def _smooth(self, points: NDArray[np.float64], circles: Circles) -> NDArray[np.float64]:
        """Repeatedly moves each point towards the middle of its neighbours, if it stays clear."""
        for _ in range(80):
            moved = 0.5 * points[1:-1] + 0.25 * (points[:-2] + points[2:])
            allowed = self._has_clearance(moved, circles)
            points[1:-1][allowed] = moved[allowed]
        return _resample(points)


def obstacle_distance(obstacles: NDArray[np.bool_], reach: int) -> NDArray[np.float32]:
    """Distance from the middle of each cell to the nearest obstacle cell, in cells.

    A Euclidean distance transform in two passes, along the columns and across them, exact up to
    `reach` and clamped there. The outside of the grid counts as an obstacle.

    Args:
        obstacles: Shape (height, width).
        reach: Maximum distance, in cells.

    Returns:
        Shape (height, width).
    """
    padded = np.pad(obstacles, 1, constant_values=True)

    def squared(steps: int) -> float:
        return max(0.0, steps - 0.5) ** 2  # to the near edge of a cell that many steps away

    vertical = np.where(padded, 0.0, float(reach) ** 2).astype(np.float32)
    for steps in range(1, reach + 1):
        for shifted, source in _shifts(steps):
            near = np.where(padded[source], np.float32(squared(steps)), np.inf)
            np.minimum(vertical[shifted], near, out=vertical[shifted])
    both = vertical.copy()
    for steps in range(1, reach + 1):
        for shifted, source in _shifts(steps):
            near = vertical.T[source] + np.float32(squared(steps))
            np.minimum(both.T[shifted], near, out=both.T[shifted])
    return np.sqrt(both[1:-1, 1:-1])


def _shifts(steps: int) -> list[tuple[slice, slice]]:
    """Pairs of row ranges: rows, and the rows that many steps before or after them."""
    return [(slice(steps, None), slice(None, -steps)), (slice(None, -steps), slice(steps, None))]


def _resample(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the same line with at least two points, about `SPACING` apart; its ends are kept."""
    lengths = np.hypot(*np.diff(points, axis=0).T) if len(points) > 1 else np.zeros(0)
    travelled = np.concatenate([[0.0], np.cumsum(lengths)])
    count = max(2, math.ceil(travelled[-1] / SPACING) + 1)
    at = np.linspace(0.0, travelled[-1], count)
    return np.column_stack([np.interp(at, travelled, points[:, axis]) for axis in (0, 1)])
