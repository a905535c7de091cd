"""Networks without multicast."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation


class NoMulticast(Check):
    """No interface has multicast.

    No interface of the network besides loopback has the flag MULTICAST.

    Why:
        DDS finds other machines by multicast. Without it, only peers that are listed are found.

    Repair:
        Switch it on, or list the peers in ROS_STATIC_PEERS:

            sudo ip link set eth0 multicast on
    """

    id = "NET001"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        interfaces = observation.environment.interfaces if observation.environment else ()
        outer = [each for each in interfaces if not each.is_loopback]
        if not outer or any(each.has_multicast for each in outer):
            return
        explains = observation.undiscovered()
        yield self.found(
            f"No interface of the network has multicast: {', '.join(each.name for each in outer)}.",
            "Switch multicast on, or list the other machines in ROS_STATIC_PEERS.",
            severity=Severity.WARNING if explains else Severity.NOTE,
            evidence={"interfaces": tuple(each.name for each in outer)},
            command=f"sudo ip link set {outer[0].name} multicast on",
            explains=explains,
        )
