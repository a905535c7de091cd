"""Displays of what sensors measure: distances, points and single numbers."""

from webviz_displays.sensors.fluid_pressure import FluidPressure
from webviz_displays.sensors.illuminance import Illuminance
from webviz_displays.sensors.point_cloud import PointCloud
from webviz_displays.sensors.range import Range
from webviz_displays.sensors.relative_humidity import RelativeHumidity
from webviz_displays.sensors.temperature import Temperature

__all__ = ["FluidPressure", "Illuminance", "PointCloud", "Range", "RelativeHumidity", "Temperature"]
