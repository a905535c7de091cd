"""Multicast that does not return."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation


class MulticastLost(Check):
    """Multicast does not return.

    A multicast packet that this machine sends to itself does not arrive.

    Why:
        A firewall drops it, or no route leads to the multicast addresses. DDS then finds no node by
        multicast.

    Repair:
        Allow multicast in the firewall, or add a route:

            sudo ip route add 224.0.0.0/4 dev eth0
    """

    id = "NET002"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        environment = observation.environment
        if environment is None or environment.multicast_returns is not False:
            return
        outer = [each for each in environment.interfaces if not each.is_loopback]
        if not outer:
            return  # NET003 reports that no network is up
        explains = observation.undiscovered()
        names = tuple(each.name for each in environment.interfaces)
        best = next((each.name for each in outer if each.has_multicast), outer[0].name)
        yield self.found(
            "A multicast packet of this machine to itself does not arrive.",
            "Allow multicast in the firewall, or add a route for 224.0.0.0/4.",
            severity=Severity.WARNING if explains else Severity.NOTE,
            evidence={"interfaces": names},
            command=f"sudo ip route add 224.0.0.0/4 dev {best}",
            explains=explains,
        )
