"""Zenoh networks that do not fit the viewer."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation


class ZenohNetwork(Check):
    """Zenoh network that does not fit the viewer.

    The router is connected, but the ROS domain has no nodes while another has some, publishers have
    another version of a type than this machine or than those who subscribe, a zenoh-bridge-ros2dds
    routes nothing, two ways lead to one robot, liveliness tokens are invalid, or the router does
    not answer.

    Why:
        Zenoh passes on whatever matches by key, and keys begin with the domain and end with the
        version of the type. What does not match is silent on both sides.

    Repair:
        Start webviz in the domain of the robot:

            ROS_DOMAIN_ID=7 webviz --connect tcp/robot:7447

        Source the workspace from which the robot's messages were built, and have one way to it:
        rmw_zenoh or zenoh-bridge-ros2dds.
    """

    id = "NET014"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each remark on a link over Zenoh."""
        for bridge in observation.zenoh_links:
            keys = ("Connection", f"Connection to {bridge.title}")
            explains = [symptom for key in keys for symptom in observation.symptom(key)]
            if not any(offer.publishers for offer in observation.offers.values()):
                explains += observation.undiscovered()
            for number, remark in enumerate(bridge.remarks):
                cause, _, remedy = remark.partition(". ")
                yield self.found(
                    f"{cause}.",
                    remedy or "Check the network.",
                    # A check has one finding for each subject.
                    subject=f"{bridge.name} {number}" if number else bridge.name,
                    evidence={"router": bridge.name, "remark": remark},
                    explains=tuple(explains),
                )
