"""Discovery ranges that ROS does not know."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation

RANGE = "ROS_AUTOMATIC_DISCOVERY_RANGE"
RANGES = ("SUBNET", "LOCALHOST", "OFF", "SYSTEM_DEFAULT")


class InvalidDiscoveryRange(Check):
    """Invalid discovery range.

    ROS_AUTOMATIC_DISCOVERY_RANGE has a value that ROS does not know.

    Why:
        ROS then looks for nodes on this machine only, and says so in a single line of the log.

    Repair:
        Use SUBNET, LOCALHOST, OFF or SYSTEM_DEFAULT.
    """

    id = "ENV004"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        variables = observation.environment.variables if observation.environment else {}
        value = variables.get(RANGE, "")
        if value and value.upper() not in RANGES:
            yield self.found(
                f"{RANGE} is {value}, which ROS does not know.",
                f"Use {', '.join(RANGES)}.",
                evidence={RANGE: value},
                command=f"export {RANGE}=SUBNET",
                explains=observation.undiscovered(),
            )
