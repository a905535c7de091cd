"""Domains of two machines."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation


class DomainsDiffer(Check):
    """Domains differ.

    This machine and its peer use different values of ROS_DOMAIN_ID.

    Why:
        Nodes of different domains do not find each other: the ports of DDS follow from the domain.

    Repair:
        Set the same domain on both machines, and start the nodes again:

            export ROS_DOMAIN_ID=42
    """

    id = "ENV020"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        ends = observation.ends
        if ends is None:
            return
        ours = ends.here.settings("ROS_DOMAIN_ID", "0")
        theirs = ends.there.settings("ROS_DOMAIN_ID", "0")
        # Nodes in several domains are no fault as long as one of them is shared.
        if ours.keys() & theirs.keys():
            return
        (our, our_source), (their, their_source) = (
            next(iter(ours.items())),
            next(iter(theirs.items())),
        )
        yield self.found(
            f"This machine uses domain {our}, {ends.there.host} uses domain {their}.",
            f"Set ROS_DOMAIN_ID to {their} here, or to {our} there, and restart the nodes.",
            subject=ends.there.host,
            severity=Severity.ERROR,
            evidence={
                "here": our,
                "here_from": our_source,
                "there": their,
                "there_from": their_source,
            },
            command=f"export ROS_DOMAIN_ID={their}" if their.isdecimal() else "",
        )
