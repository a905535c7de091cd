"""Interfaces that lead elsewhere."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation

NAMES = ("docker", "br-", "veth", "tun", "tap", "wg", "virbr", "zt", "tailscale")


class OtherInterfaces(Check):
    """Interface of a container or a VPN.

    Besides the interface of the robot, one of Docker or of a VPN is up.

    Why:
        DDS announces all addresses. Peers may try one that they cannot reach, and multicast may
        leave through the wrong interface.

    Repair:
        If nodes are not found, allow only the interface of the robot: `ROS_STATIC_PEERS`, an
        interface list in the profile of Fast DDS, or `NetworkInterface` of Cyclone DDS.
    """

    id = "NET004"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        interfaces = observation.environment.interfaces if observation.environment else ()
        names = tuple(each.name for each in interfaces if each.name.startswith(NAMES))
        if names:
            yield self.found(
                f"Interfaces of containers or a VPN are up: {', '.join(names)}.",
                "If nodes of other machines are not found, allow only the interface of the robot.",
                severity=Severity.NOTE,
                evidence={"interfaces": names},
                command="ip -brief address",
            )
