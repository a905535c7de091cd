"""Discovery that does not leave a machine."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation

LOCAL = ("LOCALHOST", "OFF")


class DiscoveryStaysLocal(Check):
    """Discovery stays on one machine.

    One of the machines looks for nodes on itself only.

    Why:
        With ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST or OFF, or ROS_LOCALHOST_ONLY=1, nodes neither
        announce themselves to other machines nor look for them, unless ROS_STATIC_PEERS names
        those.

    Repair:
        Allow the subnet on both machines, and start the nodes again:

            export ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET
            unset ROS_LOCALHOST_ONLY
    """

    id = "ENV022"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such machine."""
        if observation.ends is None:
            return
        for end, who in (
            (observation.ends.here, "This machine"),
            (observation.ends.there, observation.ends.there.host),
        ):
            ranges = end.settings("ROS_AUTOMATIC_DISCOVERY_RANGE")
            only = end.settings("ROS_LOCALHOST_ONLY")
            name, value = "ROS_AUTOMATIC_DISCOVERY_RANGE", next(iter(ranges))
            if value not in LOCAL:
                name, value = "ROS_LOCALHOST_ONLY", next(iter(only))
                if value != "1":
                    continue
            if any(end.settings("ROS_STATIC_PEERS")):
                continue
            yield self.found(
                f"{who} discovers only its own nodes: {name} is {value}.",
                "Allow the subnet there, and restart the nodes.",
                subject=end.host,
                severity=Severity.ERROR,
                evidence={"host": end.host, name: value},
                command="export ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET; unset ROS_LOCALHOST_ONLY",
            )
