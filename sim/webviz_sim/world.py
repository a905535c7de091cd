"""The world: an occupancy image and its YAML, read as by nav2's map_server."""

import math
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from webviz.data.map_file import FREE, MapFileError, read_map
from webviz_sim.pose import Pose2D

# Occupancies at which a cell counts as occupied or free by map_saver's defaults.
OCCUPIED_FROM, FREE_BELOW = 65, 25


class WorldError(ValueError):
    """A world cannot be loaded; the text is one sentence that says why."""


@dataclass(frozen=True)
class World:
    """An occupancy grid, placed in the map frame."""

    cells: NDArray[np.int8]
    """Shape (height, width): 0 free to 100 occupied, -1 unknown; row 0 is at the origin."""
    resolution: float
    """Edge of a cell in metres."""
    origin: Pose2D
    """The outer corner of cell (0, 0) in the map frame; rows run along its y axis."""

    @cached_property
    def occupied(self) -> NDArray[np.bool_]:
        """Shape (height, width): where beams end and the robot cannot be."""
        return self.cells >= OCCUPIED_FROM

    @cached_property
    def traversable(self) -> NDArray[np.bool_]:
        """Shape (height, width): cells that are known to be free."""
        return (self.cells >= FREE) & (self.cells < FREE_BELOW)

    @cached_property
    def _rotation(self) -> NDArray[np.float64]:
        cos, sin = math.cos(self.origin.yaw), math.sin(self.origin.yaw)
        return np.array([[cos, -sin], [sin, cos]])

    def to_grid(self, pose: Pose2D) -> Pose2D:
        """Return a pose in the map frame converted to the grid's frame, with x and y in cells."""
        local = self.origin.inverse() @ pose
        return Pose2D(local.x / self.resolution, local.y / self.resolution, local.yaw)

    def to_cells(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the reverse of `to_map`."""
        return (points - (self.origin.x, self.origin.y)) @ self._rotation / self.resolution

    def to_map(self, cells: NDArray[np.float64]) -> NDArray[np.float64]:
        """Points in the map frame, in metres.

        Args:
            cells: Shape (n, 2), x and y in the grid's frame, in cells.

        Returns:
            Shape (n, 2), x and y in metres.
        """
        return cells * self.resolution @ self._rotation.T + (self.origin.x, self.origin.y)

    def clearance(self, pose: Pose2D, reach: float) -> float:
        """Exact distance in metres from a point to the nearest wall, at most `reach`.

        The outside of the grid counts as wall. The pose is in the map frame, its yaw is ignored.
        """
        height, width = self.cells.shape
        x, y, _ = self.to_grid(pose)
        cells = reach / self.resolution
        edge = max(0.0, min(x, y, width - x, height - y))
        left, right = max(0, math.floor(x - cells)), max(0, math.ceil(x + cells))
        low, high = max(0, math.floor(y - cells)), max(0, math.ceil(y + cells))
        rows, columns = np.nonzero(self.occupied[low:high, left:right])
        if len(rows):
            # Distance from a point to a unit square along each axis.
            dx = np.maximum(np.abs(columns + (left + 0.5 - x)) - 0.5, 0.0)
            dy = np.maximum(np.abs(rows + (low + 0.5 - y)) - 0.5, 0.0)
            edge = min(edge, math.sqrt(np.min(dx * dx + dy * dy)))
        return min(edge * self.resolution, reach)


def load_world(path: str | Path) -> World:
    """Load a map.

    Args:
        path: The yaml file; `image` in it is relative to the yaml's folder.

    Raises:
        WorldError: A file is missing or unreadable, or an entry is missing or invalid.
    """
    try:
        file = read_map(Path(path))
    except MapFileError as error:
        raise WorldError(str(error)) from None
    return World(file.cells, file.resolution, Pose2D(*file.origin))
