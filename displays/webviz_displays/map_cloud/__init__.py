"""The clouds that RTAB-Map has collected."""

from webviz_displays.map_cloud.display import MapCloud

__all__ = ["MapCloud"]
