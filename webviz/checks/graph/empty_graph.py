"""Graph without any other node."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation

OVER_ZENOH = (
    "Start the robot with RMW_IMPLEMENTATION=rmw_zenoh_cpp and a connection to this router, or a "
    "zenoh-bridge-ros2dds beside it."
)


class EmptyGraph(Check):
    """No other node found.

    webviz is the only node of its ROS graph: discovery has found no participant besides it.

    Why:
        No display can show anything until nodes are discovered. Either no node is running, or the
        nodes are in another domain, on another network, or behind a firewall.

    Repair:
        Start the robot. If it runs, compare the domain and the middleware on both machines:

            printenv | grep -E '^(ROS|RMW|FASTRTPS|FASTDDS|CYCLONEDDS)'

        They must agree in `ROS_DOMAIN_ID` and `RMW_IMPLEMENTATION`. Then let `ros2 multicast
        receive` wait on one machine while `ros2 multicast send` runs on the other.
    """

    id = "GRAPH001"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if the graph has one node, and topics or transforms are lacking."""
        explains = observation.undiscovered()
        if not observation.is_alone() or not explains:
            return
        domain = observation.environment.domain if observation.environment else "0"
        router = next((each.name for each in observation.zenoh_links), "")
        place = f"the Zenoh router {router}" if router else f"domain {domain}"
        has_left = any(each.received for _, each in observation.inputs())
        start = OVER_ZENOH if router else "Start the robot, or set the ROS_DOMAIN_ID of its nodes."
        yield self.found(
            f"All other ROS nodes have left {place}."
            if has_left
            else f"No other ROS node is visible {'on' if router else 'in'} {place}.",
            "Start the robot again, or restore the link to its machine." if has_left else start,
            severity=Severity.ERROR,
            evidence={
                "router" if router else "domain": router or domain,
                "nodes": (*observation.nodes,),
            },
            command="" if router else "ros2 multicast receive",
            explains=explains,
        )
