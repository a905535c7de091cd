"""Robots that are connected in two ways at once."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation
from webviz.data.words import listed

NAMED = 3


class TwoWays(Check):
    """Robot that is connected in two ways.

    A robot of the config has a connection, such as a Zenoh router, and others publish its topics
    here, too, as its nodes do over DDS.

    Why:
        Only what comes over its connection is shown, so a fault of the other way stays hidden, and
        the network carries everything twice. Commands go over the connection alone.

    Repair:
        Remove the `connection` of the robot from the config, or keep it and separate its DDS from
        this machine, by its own ROS_DOMAIN_ID or by ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST there.
    """

    id = "NET016"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such robot."""
        for bridge in observation.bridges:
            if bridge.doubled:
                topics = listed(bridge.doubled, NAMED)
                yield self.found(
                    f"Two ways lead to {bridge.title}: others publish {topics} here, besides its "
                    f"connection {bridge.name}, over which alone webviz reads.",
                    f"Remove the connection of {bridge.title} from the config, or give its DDS "
                    "another ROS_DOMAIN_ID.",
                    subject=bridge.name,
                    evidence={"connection": bridge.name, "topics": bridge.doubled},
                )
