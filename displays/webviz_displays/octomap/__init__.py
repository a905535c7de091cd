"""Octrees of occupied and free space."""

from webviz_displays.octomap.display import ColorOccupancyGrid, OccupancyGrid, OccupancyGridStamped

__all__ = ["ColorOccupancyGrid", "OccupancyGrid", "OccupancyGridStamped"]
