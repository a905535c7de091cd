"""Versions of ROS of two machines."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation


class DistributionsDiffer(Check):
    """Distributions differ.

    This machine and its peer run different distributions of ROS.

    Why:
        Definitions of messages and type hashes change between distributions. From Humble to Jazzy,
        topics of unchanged types work, and services and actions often do not.

    Repair:
        Use the same distribution on both machines, such as in a container.
    """

    id = "ENV023"

    def find(self, seen: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        ends = seen.ends
        if ends is None:
            return
        ours = {*ends.here.settings("ROS_DISTRO")} - {""} or {*ends.here.distributions}
        theirs = {*ends.there.settings("ROS_DISTRO")} - {""} or {*ends.there.distributions}
        if ours and theirs and not ours & theirs:
            our, their = (", ".join(sorted(each)) for each in (ours, theirs))
            yield self.found(
                f"This machine runs {our}, {ends.there.host} runs {their}.",
                "If services or actions fail, use the same distribution on both machines.",
                subject=ends.there.host,
                severity=Severity.NOTE,
                evidence={"here": our, "there": their},
            )
