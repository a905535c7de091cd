"""The tree of transforms of a live graph."""

from __future__ import annotations

import contextlib
import time

import pytest

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install ros-webviz[ros]")

from bags import stamped

from webviz.data.messages import encode
from webviz.ros.node import RosSource
from webviz.shell.cli.frames import TreeRead, read_live
from webviz.sources import Advertisement

TF = "tf2_msgs/msg/TFMessage"


def test_live_frames_name_their_publisher(webviz_domain: int) -> None:
    with (
        contextlib.closing(RosSource(domain_id=webviz_domain, node_name="odometry")) as robot,
        contextlib.closing(RosSource(domain_id=webviz_domain)) as source,
    ):

        def publish(*_: object) -> None:
            transforms = [stamped("odom", "base_link", time.time_ns())]
            robot.graph.publish(Advertisement("/tf", TF), encode(TF, {"transforms": transforms}))

        def read() -> TreeRead:
            return read_live(source, 0.5, publish)

        def is_named(tree: TreeRead) -> bool:
            """Return whether a transform came; who publishes is known before."""
            return any("/odometry" in each.publishers for each in tree.diagnosis.frames)

        deadline = time.monotonic() + 60.0
        while not is_named(tree := read()) and time.monotonic() < deadline:
            pass
    (report,) = tree.diagnosis.frames
    assert (report.frame, report.parent) == ("base_link", "odom")
    assert report.publishers == ("/odometry",)
    assert tree.notes() == ["/tf is published by /odometry."]
