"""Publishers that have sent nothing."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation

STREAMS = {
    *(
        f"sensor_msgs/msg/{name}"
        for name in (
            "CameraInfo",
            "CompressedImage",
            "FluidPressure",
            "Illuminance",
            "Image",
            "Imu",
            "JointState",
            "LaserScan",
            "MagneticField",
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
        The node runs and waits for something itself: a sensor that is off, an input topic, or its
        activation, if it is a lifecycle node.

    Repair:
        Look at the log of the node. Of a lifecycle node, print the state, which must be `active`:

            ros2 lifecycle get /slam_toolbox
    """

    id = "GRAPH008"

    def find(self, seen: Observation) -> Iterator[Finding]:
        """Yield a finding for each topic that is published, matches, and is silent."""
        for display, each, offer in seen.starved():
            publishers = [p for p in offer.publishers if p.type in each.types]
            if each.received or offer.problem or not publishers or seen.is_recorded:
                continue
            is_refused = offer.requested is None or display.problem(each.status) is None
            if is_refused or (display.statuses[each.status].remedy is not None):
                continue
            node = publishers[0].label
            yield self.found(
                f"{node} publishes {each.topic}, but has sent nothing yet.",
                "Check what the node waits for: its sensor, its inputs, or its activation.",
                subject=each.topic,
                severity=Severity.WARNING if {*each.types} & STREAMS else Severity.NOTE,
                evidence={"topic": each.topic, "nodes": tuple(p.label for p in publishers)},
                command=f"ros2 node info {node}" if publishers[0].node else "",
                explains=display.symptom(each.status),
            )
