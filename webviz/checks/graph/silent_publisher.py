"""Publishers from which nothing has arrived."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import NO_OFFER, Observation
from webviz.checks.frames.odometry_missing import odometry_lost
from webviz.checks.graph.inactive_node import lifecycle_nodes
from webviz.checks.graph.silence import is_nameless, is_silent
from webviz.data.words import joined
from webviz.sources.names import is_own

MAP = "nav_msgs/msg/OccupancyGrid"
ODOMETRY = "nav_msgs/msg/Odometry"
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
    MAP,
    ODOMETRY,
    "tf2_msgs/msg/TFMessage",
}
"""Types that a node sends unprompted; others, such as goals, wait for an event."""

OVER_ZENOH = "Over Zenoh, `access_control` of a router may deny its messages, too."


class SilentPublisher(Check):
    """Publisher from which nothing arrives.

    A topic has a publisher that matches the display, but no message has arrived since webviz began
    to listen. Of goals, paths, markers and others that are sent on an event it is a note.

    Why:
        The node waits for something itself, such as a sensor that is off or an input topic, or it
        hangs; its machine or the link to it may have failed, which DDS notices after its lease of
        about 20 s; or it sent its message earlier and, being volatile, does not repeat it.

    Repair:
        Look at the log of the node, and at the topics that it subscribes to:

            ros2 node info /slam_toolbox
    """

    id = "GRAPH008"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each topic that is published, matches, and is silent."""
        senders = {p.node for p in observation.offers.get("/tf", NO_OFFER).publishers if p.node}
        for display, each, offer in observation.starved():
            if not is_silent(observation, display, each, offer) or is_nameless(offer):
                continue
            if lifecycle_nodes(observation, offer.publishers):
                continue
            publishers = [p for p in offer.publishers if p.type in each.types]
            if all(is_own(p.node) for p in publishers):
                continue
            node = publishers[0].label
            is_sender = any(p.node in senders for p in publishers)
            is_repeated = any(p.durability == "transient_local" for p in publishers)
            is_single = each.types[0] not in STREAMS or each.types[0] == MAP
            earlier = "Let it publish as transient local if it sent a message earlier."
            yield self.found(
                f"Nothing has arrived on {each.topic} from {node} since webviz began to listen "
                f"{each.silence} ago.",
                joined(
                    "Check what the node waits for, such as its sensor or its inputs.",
                    OVER_ZENOH if observation.zenoh_links else "",
                    earlier if is_single and not is_repeated else "",
                ),
                subject=each.topic,
                severity=Severity.WARNING if {*each.types} & STREAMS else Severity.NOTE,
                evidence={
                    "topic": each.topic,
                    "nodes": tuple(p.label for p in publishers),
                    "silent_s": round(each.silent_s, 1),
                },
                command=f"ros2 node info {node}" if publishers[0].node else "",
                explains=(
                    *display.symptom(each.status),
                    *(odometry_lost(observation) if is_sender and ODOMETRY in each.types else ()),
                ),
            )
