"""Numbers hidden in coordinates, by which a client knows which publication it looks at.

A marked stream has a lane. Publication n of lane l carries the coordinate `l * 128 + 1 + n / 256`
(n modulo 16384): exact in float32, of metres a viewer draws without complaint, and different for
every lane whatever the viewer calls its nodes.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

LANE_M = 128.0
CYCLE = 16_384
PER_METRE = 256


class Place(StrEnum):
    """Place of the marked coordinate in a picture."""

    FIRST_POINT = "x of the first point of a scan or a cloud"
    FIRST_VERTEX = "x of the first vertex of a line"
    LAST_POSE = "z of the last arrow of a trail"
    FRAME = "x of a frame at z = -7"
    LINK = "x of a robot's link at z = -8"
    PICTURE = "a strip in a map"


FRAME_Z, LINK_Z = -7.0, -8.0


@dataclass(frozen=True)
class Lane:
    """Marks that make publications of one stream recognisable."""

    number: int
    place: Place
    cycle: int = CYCLE
    """Publications after which numbers come again."""

    def encode(self, publication: int) -> float:
        """The coordinate of a publication, in metres."""
        return self.number * LANE_M + 1 + publication % self.cycle / PER_METRE

    def decode(self, coordinate: float) -> int | None:
        """The publication modulo CYCLE, None if the coordinate is no mark of this lane."""
        steps = (coordinate - self.number * LANE_M - 1) * PER_METRE
        if not -0.01 < steps < CYCLE - 0.5 or abs(steps - round(steps)) > 0.01:
            return None
        return round(steps)
