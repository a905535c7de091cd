"""The Camera display."""

from webviz_displays.camera.display import Camera

__all__ = ["Camera"]
