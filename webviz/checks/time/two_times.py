"""Data and transforms of two clocks."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.data.transforms.reasons import Kind


class TwoTimes(Check):
    """Data and transforms of two clocks.

    The stamps of data and of its transforms cannot come from one clock.

    Why:
        One of the nodes uses simulated time and the other wall time, or two machines disagree about
        the date.

    Repair:
        Set use_sim_time alike for all nodes, or synchronise the clocks.
    """

    id = "TIME011"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield one finding for all such links."""
        unplaced = list(observation.unplaced(Kind.CLOCKS))
        for _, reason in unplaced[:1]:
            yield self.found(
                f'Data in "{reason.frame}" and the transform of "{reason.link}" are stamped by '
                "different clocks.",
                "Set use_sim_time alike for all nodes, or synchronise the clocks of the machines.",
                subject=reason.link,
                severity=Severity.ERROR,
                evidence={"frame": reason.frame, "link": reason.link},
                command="for n in $(ros2 node list); do ros2 param get $n use_sim_time; done",
                explains=(
                    *(symptom for symptom, _ in unplaced),
                    *observation.symptom("Clocks"),
                    *(other for other, _ in observation.unplaced(Kind.AHEAD, Kind.NO_DATA)),
                ),
            )
