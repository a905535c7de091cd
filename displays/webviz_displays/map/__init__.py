"""Occupancy grids: maps and costmaps."""

from webviz_displays.map.costmap import Costmap
from webviz_displays.map.display import Map

__all__ = ["Costmap", "Map"]
