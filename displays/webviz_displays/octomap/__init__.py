"""Octrees of occupied and free space."""

from webviz_displays.octomap.display import ColorOccupancyGrid, OccupancyGrid, OccupancyGridStamped
from webviz_displays.octomap.projection import OccupancyMap, OccupancyMapStamped

__all__ = [
    "ColorOccupancyGrid",
    "OccupancyGrid",
    "OccupancyGridStamped",
    "OccupancyMap",
    "OccupancyMapStamped",
]
