"""Number of points that browsers can hold."""

from __future__ import annotations

import threading
from collections.abc import Mapping

from webviz.api.nodes import POINTS_HELD
from webviz.scene.adapter import Adapter
from webviz.server.channel.messages import FromPage, Number

FEWEST_POINTS, MAX_POINTS = 100_000, 6_400_000
"""No browser gets fewer, however slow it is or says it is; none gets more, as each point of
a cloud that moves costs the viewer and the network, too."""


class PointCapacity(FromPage, frozen=True):
    """Says how many points a page draws 20 times a second, once it has measured it.

    Operators see fewer points for each other's slow browsers, but not for those of watchers.
    """

    points: Number


class PointCapacities:
    """Reports of pages on the number of points they draw fast enough.

    Args:
        link: to the server.
    """

    def __init__(self, link: Adapter) -> None:
        self._link = link
        self._lock = threading.Lock()
        self._reports: dict[int, int] = {}
        link.channel.on(PointCapacity, self._hear)

    def points(self) -> int:
        """Return the number of points every connected page that has reported draws fast enough."""
        clients = self._link.server.get_clients()
        with self._lock:
            for browser in self._reports.keys() - clients.keys():
                del self._reports[browser]
            return min(self._reports.values(), default=POINTS_HELD)

    def reports(self) -> Mapping[int, int]:
        """Return the number of points that each page draws fast enough, by id of its browser."""
        with self._lock:
            return dict(self._reports)

    def _hear(self, browser: int, report: PointCapacity) -> None:
        """Note the report of a page, on viser's event loop."""
        with self._lock:
            self._reports[browser] = min(max(report.points, FEWEST_POINTS), MAX_POINTS)
