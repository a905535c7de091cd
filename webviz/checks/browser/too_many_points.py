"""Clouds that browsers cannot draw in time."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.browser import BrowserSeen
from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.data.words import spaced

FAR = 20
"""Times more points than are drawn: what is left of a cloud may hide what matters."""


def _points(browser: BrowserSeen) -> int:
    return browser.points


class TooManyPoints(Check):
    """Too many points.

    The clouds have more points than a browser draws 20 times a second, so some are left out.

    Why:
        Each connected browser measures how many points it draws in time, and the slowest decides.
        Without a graphics card these are some hundred thousand.

    Repair:
        Show fewer clouds, set a voxel size, or open the page in a browser with a graphics card.
    """

    id = "WEB005"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such viewer."""
        slow = min(
            (each for each in observation.browsers if each.points), key=_points, default=None
        )
        points = {
            each.display.name: each.wanted_points
            for each in observation.displays
            if each.wanted_points
        }
        if slow is None or sum(points.values()) <= slow.points:
            return
        most = max(points, key=lambda name: points[name])
        yield self.found(
            f"The clouds have {spaced(sum(points.values()))} points, most of them {most}; "
            f"{slow.name} draws {spaced(slow.points)} in time.",
            f"Set a voxel size in {most}, or show fewer clouds.",
            subject=slow.name,
            severity=Severity.WARNING
            if sum(points.values()) > FAR * slow.points
            else Severity.NOTE,
            evidence={"points_held": slow.points, **points},
        )
