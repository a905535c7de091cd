"""Middlewares of two machines."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation

DEFAULT = "rmw_fastrtps_cpp"
"""Middleware of Humble to Kilted."""


class MiddlewaresDiffer(Check):
    """Middlewares differ.

    This machine and its peer use different implementations of ROS's middleware.

    Why:
        Implementations of DDS exchange most topics, but services and actions often fail between
        them, and none of them reaches Zenoh.

    Repair:
        Use the same on both machines, and start the nodes again:

            export RMW_IMPLEMENTATION=rmw_fastrtps_cpp
    """

    id = "ENV021"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        ends = observation.ends
        if ends is None:
            return
        ours = ends.here.settings("RMW_IMPLEMENTATION", DEFAULT)
        theirs = ends.there.settings("RMW_IMPLEMENTATION", DEFAULT)
        if ours.keys() & theirs.keys():
            return
        our, their = next(iter(ours)), next(iter(theirs))
        is_foreign = ("zenoh" in our) != ("zenoh" in their)
        yield self.found(
            f"This machine uses {our}, {ends.there.host} uses {their}.",
            f"Set RMW_IMPLEMENTATION to {their} here, or to {our} there, and start the nodes "
            "again.",
            subject=ends.there.host,
            severity=Severity.ERROR if is_foreign else Severity.WARNING,
            evidence={"here": our, "there": their, "there_from": theirs[their]},
            command=f"export RMW_IMPLEMENTATION={their}" if their.isidentifier() else "",
        )
