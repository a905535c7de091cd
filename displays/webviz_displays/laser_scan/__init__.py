"""The LaserScan display."""

from webviz_displays.laser_scan.display import LaserScan

__all__ = ["LaserScan"]
