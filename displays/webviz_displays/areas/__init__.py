"""Displays of areas."""

from webviz_displays.areas.grid_cells import GridCells
from webviz_displays.areas.polygon import Polygon

__all__ = ["GridCells", "Polygon"]
