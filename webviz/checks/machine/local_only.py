"""Discovery that is limited to this machine."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation


class LocalDiscovery(Check):
    """Discovery is limited to this machine.

    ROS_LOCALHOST_ONLY is 1, or ROS_AUTOMATIC_DISCOVERY_RANGE is LOCALHOST, and no other node is
    visible.

    Why:
        With either variable, ROS looks for nodes on this machine only, so that a robot elsewhere is
        not found, even in the same domain.

    Repair:
        Remove the variable on both machines, and start the nodes again:

            unset ROS_LOCALHOST_ONLY ROS_AUTOMATIC_DISCOVERY_RANGE

        If the robot is simulated on this machine, start its nodes instead.
    """

    id = "ENV016"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so, and topics or transforms are lacking."""
        environment, explains = observation.environment, observation.undiscovered()
        name = environment.local_only if environment else ""
        if environment is None or not name or not explains or not observation.is_alone():
            return
        value = environment.variables[name]
        peers = " other than ROS_STATIC_PEERS" if environment.has_static_peers else ""
        yield self.found(
            f"{name} is {value}, so nodes of other machines{peers} are not found, and none of "
            f"this machine is visible in domain {environment.domain}.",
            f"If the robot is another machine, unset {name} and start webviz again; otherwise "
            "start its nodes.",
            severity=Severity.ERROR,
            evidence={name: value, "domain": environment.domain, "nodes": tuple(observation.nodes)},
            command=f"unset {name}",
            explains=explains,
        )
