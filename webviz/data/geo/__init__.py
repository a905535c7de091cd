"""Places on the earth: WGS 84, local tangent planes, UTM and map tiles."""

from webviz.data.geo.mercator import MAX_LATITUDE, MAX_ZOOM, TilePlane
from webviz.data.geo.utm import UtmPoint, to_utm
from webviz.data.geo.wgs84 import Geodetic, is_valid, to_ecef, to_enu

__all__ = [
    "MAX_LATITUDE",
    "MAX_ZOOM",
    "Geodetic",
    "TilePlane",
    "UtmPoint",
    "is_valid",
    "to_ecef",
    "to_enu",
    "to_utm",
]
