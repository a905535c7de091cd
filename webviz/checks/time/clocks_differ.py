"""Transforms of another clock."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation
from webviz.data.transforms.clocks import clock_problem, is_off
from webviz.data.transforms.reasons import YEAR_NS, Kind

OF_LINKS = Kind.AHEAD, Kind.BEHIND, Kind.NO_DATA, Kind.CLOCKS
"""Reasons why a frame behind such a transform has no pose."""


class ClocksDiffer(Check):
    """Clocks of transforms differ.

    Transforms are stamped with a time that differs from that of webviz.

    Why:
        Data and transforms of different clocks do not meet: the data waits for transforms that come
        too late or came long ago.

    Repair:
        Synchronise the clocks of the machines (chrony, NTP), or follow the time of a bag that is
        replayed with `--clock`.
    """

    id = "TIME010"

    def find(self, seen: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        explains = seen.symptom("Clocks")
        problem = clock_problem(seen.buffer, seen.now_ns, seen.is_recorded)
        # Where data has the time of this computer, webviz need not follow another: TIME011.
        links = [seen.buffer.tree.caches.get(reason.link) for _, reason in seen.lost(Kind.CLOCKS)]
        is_mixed = any(link is not None and link.newest_stamp < YEAR_NS for link in links)
        if problem and explains and not is_mixed:
            lost = [
                symptom
                for symptom, reason in seen.lost(*OF_LINKS)
                if is_off(seen.buffer, reason.frame, seen.now_ns)
            ]
            yield self.found(
                problem.cause,
                problem.remedy,
                evidence={"status": str(problem)},
                command="chronyc tracking",
                explains=(*explains, *lost, *seen.off_map()),
            )
