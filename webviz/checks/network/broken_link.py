"""Bridges that are not connected."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.data.words import joined


class BrokenLink(Check):
    """Bridge or Zenoh router that is not connected.

    The bridge or router that webviz was started with by `--connect` cannot be reached, refuses the
    connection, or has ended.

    Why:
        All topics come over this one connection. What is shown is from before it broke; webviz
        tries again until the bridge is back.

    Repair:
        Start the bridge on the robot, and let the port through its firewall:

            ros2 launch foxglove_bridge foxglove_bridge_launch.xml

        or, for rosbridge:

            ros2 launch rosbridge_server rosbridge_websocket_launch.xml

        or the router of rmw_zenoh:

            ros2 run rmw_zenoh_cpp rmw_zenohd
    """

    id = "NET007"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each link that is down."""
        for bridge in observation.bridges:
            if bridge.is_up:
                continue
            explains = [
                symptom
                for display, each, _ in observation.starved()
                for symptom in display.symptom(each.status)
            ]
            keys = ("Connection", f"Connection to {bridge.title}")
            of_viewer = [symptom for key in keys for symptom in observation.symptom(key)]
            is_alone = len(observation.bridges) == 1
            yield self.found(
                joined(f"{bridge.name} is not connected. {bridge.problem}"),
                bridge.remedy or "Check the network.",
                subject=bridge.name,
                severity=Severity.ERROR,
                evidence={"bridge": bridge.name, "was_connected": bridge.was_up},
                command=_command(bridge.protocol),
                explains=(*of_viewer, *(explains if is_alone else ())),
            )


def _command(protocol: str) -> str:
    """Return what starts a bridge or router that speaks a protocol."""
    if protocol == "Zenoh":
        return "ros2 run rmw_zenoh_cpp rmw_zenohd"
    if protocol == "rosbridge":
        return "ros2 launch rosbridge_server rosbridge_websocket_launch.xml"
    return "ros2 launch foxglove_bridge foxglove_bridge_launch.xml"
