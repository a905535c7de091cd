"""Interactive markers."""

from webviz_displays.interactive_markers.display import InteractiveMarkers

__all__ = ["InteractiveMarkers"]
