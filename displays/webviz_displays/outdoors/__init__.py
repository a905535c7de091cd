"""Displays of places on the earth."""

from webviz_displays.outdoors.aerial_map import AerialMap
from webviz_displays.outdoors.geo_path import GeoPath
from webviz_displays.outdoors.nav_sat_fix import NavSatFix

__all__ = ["AerialMap", "GeoPath", "NavSatFix"]
