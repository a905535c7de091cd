"""Interfaces without a listener for DDS."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation

RANGE = "ROS_AUTOMATIC_DISCOVERY_RANGE"


class UnheardMulticast(Check):
    """Multicast is heard on another interface.

    Programs of this machine have joined the multicast group of DDS (IGMP), but not on the interface
    by which multicast leaves.

    Why:
        A node joins on the interfaces that are up when it starts. If the network of the robot comes
        up later, as Wi-Fi does after boot, the node announces itself there and hears no answer.

    Repair:
        Start the nodes again now that the network is up. Print who listens where with

            ip maddress show
    """

    id = "NET011"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        if (environment := observation.environment) is None:
            return
        variables = environment.variables
        is_local = variables.get(RANGE, "").upper() in ("LOCALHOST", "OFF")
        is_chosen = any(
            variables.get(name) for name in ("ROS_DISCOVERY_SERVER", "ROS_LOCALHOST_ONLY")
        )
        if is_local or is_chosen or environment.profiles:
            return
        heard = tuple(each.name for each in environment.interfaces if each.hears)
        leaving = environment.multicast_interface
        if not heard or not leaving or leaving in heard:
            return
        explains = observation.undiscovered()
        yield self.found(
            f"DDS is heard on {' and '.join(heard)}, but multicast leaves by {leaving}.",
            f"Start the nodes of this machine again while {leaving} is up.",
            subject=leaving,
            severity=Severity.WARNING if explains else Severity.NOTE,
            evidence={"heard_on": heard, "leaves_by": leaving},
            command=f"ip maddress show dev {leaving}",
            explains=explains,
        )
