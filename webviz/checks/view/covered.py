"""Maps that are hidden by other maps."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import ChangeDisplay, Finding
from webviz.api.observation import DisplaySeen, Observation
from webviz.api.status import Remedy

SAME_M = 1e-3
"""Planes that are closer hide each other by their order."""
OPAQUE = 0.9998


def _covers(above: DisplaySeen, below: DisplaySeen) -> bool:
    """Return whether a map hides all of another one."""
    a, b = above.box, below.box
    if a is None or b is None or above.id == below.id:
        return False
    top, bottom = (_layer(above), above.order), (_layer(below), below.order)
    shows_through = getattr(above.display, "color_scheme", "") == "costmap"
    is_opaque = getattr(above.display, "alpha", 0.0) >= OPAQUE and not shows_through
    is_flat = max(abs(a.low[2] - b.low[2]), abs(a.high[2] - b.high[2])) < SAME_M
    covers = all(a.low[:2] <= b.low[:2] + SAME_M) and all(a.high[:2] >= b.high[:2] - SAME_M)
    return is_opaque and is_flat and covers and top > bottom


def _layer(display: DisplaySeen) -> int:
    return 0 if getattr(display.display, "draw_behind", False) else 1


class Covered(Check):
    """Hidden by another display.

    A map lies below another one that is opaque, as large, and in the same plane.

    Why:
        Of maps in one plane the later one in the list covers the earlier ones. A costmap below an
        opaque map cannot be seen.

    Repair:
        Set the alpha of the upper one to 0.7, or draw it behind (`draw_behind`).
    """

    id = "VIEW006"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such display."""
        maps = [
            each
            for each in observation.displays
            if each.box and hasattr(each.display, "draw_behind")
        ]
        for below in maps:
            above = next((each for each in maps if _covers(each, below)), None)
            if above is None:
                continue
            yield self.found(
                f"{below.display.name} is hidden by {above.display.name}, which is opaque.",
                f"Set the alpha of {above.display.name} to 0.7, or draw it behind.",
                subject=below.display.name,
                evidence={"hidden_by": above.display.name},
                button=ChangeDisplay(above.id, Remedy("alpha", 0.7, "Set alpha to 0.7")),
            )
