"""Universal Transverse Mercator coordinates."""

from __future__ import annotations

import math
from typing import NamedTuple

from webviz.data.geo.wgs84 import EQUATORIAL_RADIUS, FLATTENING

LIMIT = (-80.0, 84.0)
"""Latitudes in degrees between which UTM is defined."""
SCALE = 0.9996
FALSE_EASTING, FALSE_NORTHING = 500_000.0, 10_000_000.0
BANDS = "CDEFGHJKLMNPQRSTUVWXX"
"""Of 8 degrees each, the last of 12."""

# Krüger's series in the third flattening, to the fourth order: below a micrometre in a zone
# (Karney, Transverse Mercator with an accuracy of a few nanometers, J. Geodesy 85, 2011, eqs. 12
# and 35).
_N = FLATTENING / (2.0 - FLATTENING)
_RECTIFYING = EQUATORIAL_RADIUS / (1.0 + _N) * (1.0 + _N**2 / 4.0 + _N**4 / 64.0)
_ALPHA = (
    _N / 2.0 - 2.0 / 3.0 * _N**2 + 5.0 / 16.0 * _N**3 + 41.0 / 180.0 * _N**4,
    13.0 / 48.0 * _N**2 - 3.0 / 5.0 * _N**3 + 557.0 / 1440.0 * _N**4,
    61.0 / 240.0 * _N**3 - 103.0 / 140.0 * _N**4,
    49561.0 / 161280.0 * _N**4,
)
_ECCENTRICITY = math.sqrt(FLATTENING * (2.0 - FLATTENING))


class UtmPoint(NamedTuple):
    """A place in its zone.

    Args:
        zone: 1 to 60.
        band: letter of the latitude band.
        easting, northing: in metres.
    """

    zone: int
    band: str
    easting: float
    northing: float

    def __str__(self) -> str:
        return f"{self.zone}{self.band} {self.easting:.2f} {self.northing:.2f}"


def to_utm(latitude: float, longitude: float) -> UtmPoint | None:
    """Return UTM coordinates of a place in degrees; None near the poles, where there are none."""
    if not LIMIT[0] <= latitude <= LIMIT[1]:
        return None
    longitude = (longitude + 180.0) % 360.0 - 180.0
    zone, band = _zone(latitude, longitude), BANDS[int((latitude + 80.0) // 8.0)]
    phi, lam = math.radians(latitude), math.radians(longitude - (6.0 * zone - 183.0))
    sine = math.sin(phi)
    conformal = math.atanh(sine) - _ECCENTRICITY * math.atanh(_ECCENTRICITY * sine)
    tangent = math.sinh(conformal)
    xi = math.atan2(tangent, math.cos(lam))
    eta = math.asinh(math.sin(lam) / math.hypot(tangent, math.cos(lam)))
    north, east = xi, eta
    for order, alpha in enumerate(_ALPHA, 1):
        north += alpha * math.sin(2 * order * xi) * math.cosh(2 * order * eta)
        east += alpha * math.cos(2 * order * xi) * math.sinh(2 * order * eta)
    offset = 0.0 if latitude >= 0 else FALSE_NORTHING
    radius = SCALE * _RECTIFYING
    return UtmPoint(zone, band, FALSE_EASTING + radius * east, offset + radius * north)


def _zone(latitude: float, longitude: float) -> int:
    """Zone of a place, with the exceptions of Norway and Svalbard."""
    if 56.0 <= latitude < 64.0 and 3.0 <= longitude < 12.0:
        return 32
    if latitude >= 72.0 and 0.0 <= longitude < 42.0:
        return 31 + 2 * int((longitude + 3.0) // 12.0)
    return min(int((longitude + 180.0) // 6.0) + 1, 60)
