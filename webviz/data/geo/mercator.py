"""Web Mercator, the projection of map tiles, as a plane in metres around a place."""

from __future__ import annotations

import math

import msgspec

from webviz.data.geo.wgs84 import EQUATORIAL_RADIUS, Geodetic, radii

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
        found = [(column, row) for column in columns for row in rows]
        return sorted(found, key=lambda at: (at[0] - x) ** 2 + (at[1] - y) ** 2)
