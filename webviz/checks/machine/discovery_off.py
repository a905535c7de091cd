"""Discovery that is switched off."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation

RANGE = "ROS_AUTOMATIC_DISCOVERY_RANGE"


class DiscoveryOff(Check):
    """Discovery is off.

    ROS_AUTOMATIC_DISCOVERY_RANGE is OFF, and ROS_STATIC_PEERS names no machine.

    Why:
        Without discovery no node finds another, not even on the same machine.

    Repair:
        Let nodes find each other on this machine or in the local network:

            export ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET
    """

    id = "ENV003"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        variables = observation.environment.variables if observation.environment else {}
        if variables.get(RANGE, "").upper() != "OFF" or variables.get("ROS_STATIC_PEERS"):
            return
        yield self.found(
            f"{RANGE} is OFF, so no node finds another.",
            "Set it to SUBNET, or to LOCALHOST for nodes of this machine.",
            severity=Severity.ERROR,
            evidence={RANGE: variables[RANGE]},
            command=f"export {RANGE}=SUBNET",
            explains=observation.undiscovered(),
        )
