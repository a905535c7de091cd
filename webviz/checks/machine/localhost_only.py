"""Variables of discovery that contradict each other."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation

NEWER = ("ROS_AUTOMATIC_DISCOVERY_RANGE", "ROS_STATIC_PEERS")


class LocalhostConflict(Check):
    """ROS_LOCALHOST_ONLY overrides the discovery range.

    ROS_LOCALHOST_ONLY is set together with ROS_AUTOMATIC_DISCOVERY_RANGE or ROS_STATIC_PEERS.

    Why:
        ROS_LOCALHOST_ONLY is the older variable. Since Iron it overrides the newer ones, so that
        peers on other machines are not looked for.

    Repair:
        Remove the older variable:

            unset ROS_LOCALHOST_ONLY
    """

    id = "ENV005"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        variables = observation.environment.variables if observation.environment else {}
        others = [name for name in NEWER if variables.get(name)]
        if variables.get("ROS_LOCALHOST_ONLY") == "1" and others:
            yield self.found(
                f"ROS_LOCALHOST_ONLY overrides {' and '.join(others)}.",
                "Remove ROS_LOCALHOST_ONLY.",
                evidence={name: variables[name] for name in ("ROS_LOCALHOST_ONLY", *others)},
                command="unset ROS_LOCALHOST_ONLY",
                explains=observation.undiscovered(),
            )
