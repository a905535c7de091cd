"""Markers."""

from webviz_displays.markers.display import Marker, MarkerArray

__all__ = ["Marker", "MarkerArray"]
