"""Displays of what sensors measure: distances, points and single numbers."""

from webviz_displays.sensors.point_cloud import PointCloud
from webviz_displays.sensors.range import Range
from webviz_displays.sensors.scalars import (
    FluidPressure,
    Illuminance,
    RelativeHumidity,
    Temperature,
)

__all__ = ["FluidPressure", "Illuminance", "PointCloud", "Range", "RelativeHumidity", "Temperature"]
