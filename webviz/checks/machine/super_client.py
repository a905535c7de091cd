"""Clients of a discovery server that see only a part."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation


class NoSuperClient(Check):
    """Discovery server without SUPER_CLIENT.

    ROS_DISCOVERY_SERVER is set, and ROS_SUPER_CLIENT is not.

    Why:
        A client of a discovery server learns of those topics only that it uses itself. A viewer,
        like `ros2 topic list`, wants to know all of them.

    Repair:
        Become a super client before webviz is started:

            export ROS_SUPER_CLIENT=TRUE
    """

    id = "ENV008"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        variables = observation.environment.variables if observation.environment else {}
        is_super = variables.get("ROS_SUPER_CLIENT", "").upper() in ("TRUE", "1")
        if observation.environment and any(observation.environment.discovery_servers.values()):
            return  # without its server, its role does not matter
        if variables.get("ROS_DISCOVERY_SERVER") and not is_super:
            yield self.found(
                "A discovery server is used, and webviz is not its super client.",
                "Set ROS_SUPER_CLIENT to TRUE, and start webviz again.",
                evidence={"ROS_DISCOVERY_SERVER": variables["ROS_DISCOVERY_SERVER"]},
                command="export ROS_SUPER_CLIENT=TRUE",
                explains=observation.undiscovered(),
            )
