"""The DepthCloud display."""

from webviz_displays.depth_cloud.display import DepthCloud

__all__ = ["DepthCloud"]
