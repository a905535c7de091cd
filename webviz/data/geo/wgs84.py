"""The ellipsoid WGS 84, and local planes that touch it."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

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
