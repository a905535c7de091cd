"""Multicast that leaves by the wrong interface."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.checks.network.bridges import NAMES


class MulticastElsewhere(Check):
    """Multicast leaves through a container or a VPN.

    What this machine sends to the multicast group of DDS leaves through an interface of Docker or
    of a VPN.

    Why:
        The route decides which interface a multicast packet takes. Nodes on the network of the
        robot then never see the announcements of this machine.

    Repair:
        Route multicast through the interface of the robot:

            sudo ip route add 224.0.0.0/4 dev eth0
    """

    id = "NET010"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such machine."""
        environment = observation.environment
        name = environment.multicast_interface if environment else ""
        if environment is None or not name.startswith(NAMES):
            return
        others = [
            each.name
            for each in environment.interfaces
            if each.has_multicast and not each.is_loopback and not each.name.startswith(NAMES)
        ]
        if not others:
            return
        explains = observation.undiscovered()
        yield self.found(
            f"Multicast leaves through {name}, not through {' or '.join(others)}.",
            f"Route multicast through the interface of the robot, such as {others[0]}.",
            subject=name,
            severity=Severity.WARNING if explains else Severity.NOTE,
            evidence={"interface": name, "others": tuple(others)},
            command=f"sudo ip route add 224.0.0.0/4 dev {others[0]}",
            explains=explains,
        )
