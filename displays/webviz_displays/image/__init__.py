"""The Image display."""

from webviz_displays.image.display import Image

__all__ = ["Image"]
