"""Packets that are small."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation

USUAL = 1500
"""Bytes of a packet of Ethernet."""


class SmallMtu(Check):
    """Small packets.

    An interface of the network takes packets of less than 1500 bytes.

    Why:
        A VPN or a tunnel makes packets smaller. If a router on the way drops what is larger instead
        of saying so, small messages arrive and large ones do not.

    Repair:
        If clouds and images do not arrive, send packets that may not be fragmented to the robot,
        and lower the size until they arrive:

            ping -M do -s 1372 robot
    """

    id = "NET005"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such interface."""
        interfaces = observation.environment.interfaces if observation.environment else ()
        for each in interfaces:
            if not each.is_loopback and 0 < each.mtu < USUAL:
                yield self.found(
                    f"{each.name} takes packets of at most {each.mtu} bytes.",
                    "If large messages do not arrive, check the path to the robot.",
                    subject=each.name,
                    severity=Severity.NOTE,
                    evidence={"interface": each.name, "mtu": each.mtu},
                    command=f"ping -M do -s {each.mtu - 28} robot",
                )
