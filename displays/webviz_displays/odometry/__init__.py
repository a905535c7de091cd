"""The Odometry display."""

from webviz_displays.odometry.display import Odometry

__all__ = ["Odometry"]
