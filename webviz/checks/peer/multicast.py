"""Multicast between two machines."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation


class MulticastBlocked(Check):
    """Multicast does not arrive.

    Single packets arrive at the other machine, packets to the multicast group of DDS do not.

    Why:
        Nodes find each other by multicast. Access points, switches with IGMP snooping and no
        querier, bridges of containers and VPNs drop it, and routers do not forward it.

    Repair:
        Allow multicast in the network, or name the other machine on both, and start the nodes
        again:

            export ROS_STATIC_PEERS=192.168.1.20
    """

    id = "NET021"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so, for both directions."""
        ends = observation.ends
        if ends is None or not (ends.out.addresses and ends.back.addresses):
            return
        broken = [f"{a.host} to {b.host}" for link, a, b in ends.links() if not link.has_multicast]
        if not broken:
            return
        if all(any(end.settings("ROS_STATIC_PEERS")) for end in (ends.here, ends.there)):
            return
        ours, theirs = ends.back.addresses[0], ends.out.addresses[0]
        where = "" if ends.shares_network else " The machines are in different subnets."
        yield self.found(
            f"Multicast does not arrive: {' and '.join(broken)}.{where}",
            f"Set ROS_STATIC_PEERS to {theirs} here and to {ours} there, and start the nodes "
            "again.",
            subject=ends.there.host,
            severity=Severity.ERROR,
            evidence={
                "lost": tuple(broken),
                "networks_here": tuple(ends.here.networks),
                "networks_there": tuple(ends.there.networks),
            },
            command=f"export ROS_STATIC_PEERS={theirs}",
        )
