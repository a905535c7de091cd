"""Publishers that have sent nothing."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.checks.graph.inactive_node import lifecycle_nodes
from webviz.checks.graph.silence import is_nameless, is_silent

STREAMS = {
    *(
        f"sensor_msgs/msg/{name}"
        for name in (
            "CameraInfo",
            "BatteryState",
            "CompressedImage",
            "FluidPressure",
            "Illuminance",
            "Image",
            "Imu",
            "JointState",
            "LaserScan",
            "MagneticField",
            "NavSatFix",
            "PointCloud",
            "PointCloud2",
            "Range",
            "RelativeHumidity",
            "Temperature",
        )
    ),
    "nav_msgs/msg/OccupancyGrid",
    "nav_msgs/msg/Odometry",
    "tf2_msgs/msg/TFMessage",
}
"""Types that a node sends by itself; others, such as goals, wait for an event."""


class SilentPublisher(Check):
    """Publisher that sends nothing.

    A topic has a publisher that matches the display, but no message has arrived. Of goals, paths,
    markers and others that are sent on an event it is a note.

    Why:
        The node runs and waits for something itself, such as a sensor that is off or an input
        topic.

    Repair:
        Look at the log of the node, and at the topics that it subscribes to:

            ros2 node info /slam_toolbox
    """

    id = "GRAPH008"

    def find(self, seen: Observation) -> Iterator[Finding]:
        """Yield a finding for each topic that is published, matches, and is silent."""
        for display, each, offer in seen.starved():
            if not is_silent(seen, display, each, offer) or is_nameless(offer):
                continue
            if lifecycle_nodes(seen, offer.publishers):
                continue
            publishers = [p for p in offer.publishers if p.type in each.types]
            node = publishers[0].label
            yield self.found(
                f"{node} publishes {each.topic}, but has sent nothing yet.",
                "Check what the node waits for, such as its sensor or its inputs.",
                subject=each.topic,
                severity=Severity.WARNING if {*each.types} & STREAMS else Severity.NOTE,
                evidence={"topic": each.topic, "nodes": tuple(p.label for p in publishers)},
                command=f"ros2 node info {node}" if publishers[0].node else "",
                explains=display.symptom(each.status),
            )
