"""Maps of several layers, such as elevation maps."""

from webviz_displays.grid_map.display import GridMap

__all__ = ["GridMap"]
