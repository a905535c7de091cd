"""Odometry that contradicts the transform of its own node."""

from __future__ import annotations

import math
from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import NO_OFFER, Observation
from webviz.checks.data.motion import ODOMETRY
from webviz.data.rotations import angle_between, w_first
from webviz.data.transforms import TransformException
from webviz.data.transforms.clocks import is_off

APART_M, APART_RAD = 0.1, 0.1
"""Differences that neither rounding nor interpolation explains."""


class OdometryFrame(Check):
    """Odometry against its own transform.

    A node publishes an odometry and the transform between the same two frames, and they differ at
    the same time.

    Why:
        One of the two is computed in another way, such as in another frame, without the first
        pose, or from the speeds that were asked for. What is drawn follows the transform, while
        planners read the topic.

    Repair:
        Publish both from one pose, or only one of them. Compare

            ros2 topic echo --once --field pose.pose /odom
            ros2 run tf2_ros tf2_echo odom base_link
    """

    id = "DATA021"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such topic."""
        if observation.is_recorded:
            return  # a recording does not tell which node sent what
        # Transforms whose own fault has another name differ from anything.
        faulty = {each.subject for each in observation.findings if each.id == "TF026"}
        faulty |= {frame for frame, _ in observation.buffer.conflicts.all()}
        transforms = observation.offers.get("/tf", NO_OFFER).publishers
        senders = {each.node for each in transforms if each.node}
        for _, each in observation.samples(ODOMETRY):
            odometry = each.message
            parent, child = odometry.header.frame_id, odometry.child_frame_id
            nodes = {p.node for p in observation.offers.get(each.topic, NO_OFFER).publishers}
            link = observation.buffer.link(child)
            if not nodes & senders or link is None or link.parent != parent or child in faulty:
                continue
            if is_off(observation.buffer, child, observation.now_ns):
                continue
            stamp = odometry.header.stamp
            try:
                transform = observation.buffer.lookup(
                    parent, child, stamp.sec * 10**9 + stamp.nanosec
                )
            except TransformException:
                continue
            place, q = odometry.pose.pose.position, odometry.pose.pose.orientation
            turned = w_first(transform.rotation)
            apart_m = math.dist(transform.translation, (place.x, place.y, place.z))
            apart_rad = angle_between(tuple(turned.tolist()), (q.w, q.x, q.y, q.z))
            if apart_m > APART_M or apart_rad > APART_RAD:
                node = ", ".join(sorted(nodes & senders))
                yield self.found(
                    f'The pose on {each.topic} and the transform from "{parent}" to "{child}", '
                    f"both of {node}, are {apart_m:.2f} m and {math.degrees(apart_rad):.0f}° "
                    "apart.",
                    "Publish both from one pose, or only one of them.",
                    subject=each.topic,
                    evidence={
                        "node": node,
                        "apart_m": round(apart_m, 3),
                        "apart_rad": round(apart_rad, 3),
                    },
                    command=f"ros2 run tf2_ros tf2_echo {parent} {child}",
                )
