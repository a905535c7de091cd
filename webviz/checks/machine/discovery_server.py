"""Discovery servers that cannot be reached."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation


class DiscoveryServer(Check):
    """Discovery server unreachable.

    `ROS_DISCOVERY_SERVER` names a server that does not exist, cannot be reached, or refuses
    datagrams.

    Why:
        With this variable, Fast DDS discovers nodes through the server alone. Without it, no node
        is seen.

    Repair:
        Start the server, or correct the variable:

            fastdds discovery --server-id 0
    """

    id = "ENV012"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each server that cannot be reached."""
        servers = observation.environment.discovery_servers if observation.environment else {}
        for server, problem in servers.items():
            if problem:
                yield self.found(
                    f"The discovery server {server} cannot be reached: {problem}.",
                    "Start the server, or correct ROS_DISCOVERY_SERVER.",
                    subject=server,
                    severity=Severity.ERROR,
                    evidence={"server": server, "problem": problem},
                    command="fastdds discovery --server-id 0",
                    explains=observation.undiscovered(),
                )
