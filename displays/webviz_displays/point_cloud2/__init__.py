"""The PointCloud2 display."""

from webviz_displays.point_cloud2.display import PointCloud2

__all__ = ["PointCloud2"]
