"""Places on the earth: WGS 84, local tangent planes, UTM and map tiles."""

from __future__ import annotations

import math
from typing import NamedTuple

import msgspec
import numpy as np
from numpy.typing import ArrayLike, NDArray

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

F64 = NDArray[np.float64]

EQUATORIAL_RADIUS = 6_378_137.0
"""Semi-major axis in metres (NIMA TR8350.2, table 3.1)."""
FLATTENING = 1.0 / 298.257223563
ECCENTRICITY2 = FLATTENING * (2.0 - FLATTENING)
"""Square of the first eccentricity."""


class Geodetic(NamedTuple):
    """A place: latitude and longitude in degrees, altitude above the ellipsoid in metres."""

    latitude: float
    longitude: float
    altitude: float = 0.0


def is_valid(latitude: float, longitude: float) -> bool:
    """Return whether degrees name a place: NaN and angles beyond the poles do not."""
    return abs(latitude) <= 90.0 and abs(longitude) <= 360.0


def radii(latitude: float) -> tuple[float, float]:
    """Return radii of curvature at a latitude in degrees: along the meridian, across, in metres."""
    sine2 = math.sin(math.radians(latitude)) ** 2
    across = EQUATORIAL_RADIUS / math.sqrt(1.0 - ECCENTRICITY2 * sine2)
    return across * (1.0 - ECCENTRICITY2) / (1.0 - ECCENTRICITY2 * sine2), across


def to_ecef(places: ArrayLike) -> F64:
    """Earth-centred coordinates (N, 3) in metres of places (N, 3): degrees, degrees, metres."""
    latitude, longitude, altitude = np.asarray(places, np.float64).T
    phi, lam = np.radians(latitude), np.radians(longitude)
    across = EQUATORIAL_RADIUS / np.sqrt(1.0 - ECCENTRICITY2 * np.sin(phi) ** 2)
    level = (across + altitude) * np.cos(phi)
    height = (across * (1.0 - ECCENTRICITY2) + altitude) * np.sin(phi)
    return np.column_stack([level * np.cos(lam), level * np.sin(lam), height])


def to_enu(places: ArrayLike, origin: Geodetic) -> F64:
    """Metres to the east, north and up of an origin, (N, 3).

    Args:
        places: (N, 3), latitude and longitude in degrees, altitude in metres.
        origin: where the plane touches.
    """
    phi, lam = math.radians(origin.latitude), math.radians(origin.longitude)
    east = (-math.sin(lam), math.cos(lam), 0.0)
    up = (math.cos(phi) * math.cos(lam), math.cos(phi) * math.sin(lam), math.sin(phi))
    axes = np.array([east, np.cross(up, east), up])
    return (to_ecef(places) - to_ecef([origin])) @ axes.T


LIMIT = (-80.0, 84.0)
"""Latitudes in degrees between which UTM is defined."""
SCALE = 0.9996
FALSE_EASTING, FALSE_NORTHING = 500_000.0, 10_000_000.0
BANDS = "CDEFGHJKLMNPQRSTUVWXX"
"""Bands of 8 degrees each, the last of 12."""

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


MAX_LATITUDE = math.degrees(math.atan(math.sinh(math.pi)))
"""Degrees; tiles end there, as the square of level 0 does."""
MAX_ZOOM = 22


class TilePlane(msgspec.Struct, frozen=True):
    """Tiles of one zoom level around a place.

    The projection is conformal on a sphere only: at 60 degrees, a map would be 0.5 % too long from
    north to south. So both directions are scaled to the ellipsoid at the origin; tiles still fit
    without gaps.

    Args:
        origin: where distances are true.
        zoom: 0 to `MAX_ZOOM`.
    """

    origin: Geodetic
    zoom: int

    @property
    def center(self) -> tuple[float, float]:
        """The origin in tiles, from the north-western corner of the world: x east, y south."""
        phi = math.radians(max(-MAX_LATITUDE, min(MAX_LATITUDE, self.origin.latitude)))
        x = (self.origin.longitude + 180.0) / 360.0
        y = 0.5 - math.asinh(math.tan(phi)) / math.tau
        return (x % 1.0) * self.count, y * self.count

    @property
    def count(self) -> int:
        """Tiles from west to east, and from north to south."""
        return 1 << self.zoom

    @property
    def size(self) -> tuple[float, float]:
        """Width and height of a tile at the origin in metres."""
        phi = math.radians(self.origin.latitude)
        along, across = radii(self.origin.latitude)
        tile = math.tau * EQUATORIAL_RADIUS / self.count * math.cos(phi)
        return tile * across / EQUATORIAL_RADIUS, tile * along / EQUATORIAL_RADIUS

    def corner(self, x: int, y: int) -> tuple[float, float]:
        """Return the south-western corner of a tile, in metres east and north of the origin.

        Args:
            x: column; may be outside 0 to `count`, beyond the date line.
            y: row.
        """
        width, height = self.size
        center_x, center_y = self.center
        return (x - center_x) * width, (center_y - y - 1) * height

    def around(self, blocks: int) -> list[tuple[int, int]]:
        """Return the tile of the origin and `blocks` to each side, nearest first: column, row."""
        x, y = map(int, self.center)
        last = self.count - 1
        rows = range(max(0, y - blocks), min(last, y + blocks) + 1)
        width = min(2 * blocks + 1, self.count)
        columns = range(x - width // 2, x - width // 2 + width)
        tiles = [(column, row) for column in columns for row in rows]
        return sorted(tiles, key=lambda at: (at[0] - x) ** 2 + (at[1] - y) ** 2)
