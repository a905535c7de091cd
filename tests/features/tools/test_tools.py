"""Messages published by the tools, compared with RViz2's."""

from __future__ import annotations

import math
from typing import Any

import pytest
from bench import Bench, Benches

from webviz.api.status import Level, Status
from webviz.commands import SetToolProperty, UseTool
from webviz.shell.testing.remembering_graph import RememberingGraph
from webviz.sources import Advertisement

QUARTER = math.pi / 2


@pytest.fixture
def b(bench: Benches) -> Bench:
    b = bench()
    b.source.graph = RememberingGraph()
    b.source.now = 112_000_000_345
    b.turn()
    return b


def use(b: Bench, tool: str, x: float, y: float, z: float = 0.0, yaw: float = 0.0) -> Any:
    """Return what a tool publishes for a gesture, and where."""
    answer = b.viewer.enqueue(UseTool(tool, ((x, y, z),), yaw))
    b.turn()
    assert answer.result() == ""
    ((advertisement, message),) = b.graph.published
    stamp = message.header.stamp
    assert (message.header.frame_id, stamp.sec, stamp.nanosec) == ("map", 112, 345)
    return advertisement, message


def test_a_pose_estimate_has_the_covariance_of_rviz(b: Bench) -> None:
    advertisement, estimate = use(b, "2D Pose Estimate", 1.0, 2.0, yaw=QUARTER)
    assert advertisement == Advertisement(
        "/initialpose", "geometry_msgs/msg/PoseWithCovarianceStamped"
    )
    pose = estimate.pose.pose
    assert (pose.position.x, pose.position.y, pose.position.z) == (1.0, 2.0, 0.0)
    assert (pose.orientation.x, pose.orientation.y) == (0.0, 0.0)
    assert (pose.orientation.z, pose.orientation.w) == pytest.approx((math.sqrt(0.5),) * 2)
    expected = [0.0] * 36
    expected[0] = expected[7] = 0.25
    expected[35] = 0.06853891945200942
    assert list(estimate.pose.covariance) == pytest.approx(expected)


def test_the_covariance_of_a_pose_estimate_is_that_of_the_properties(b: Bench) -> None:
    for axis, value in (("x", 1.0), ("y", 4.0), ("yaw", 9.0)):
        b.viewer.enqueue(SetToolProperty("2D Pose Estimate", f"covariance_{axis}", value))
    _, estimate = use(b, "2D Pose Estimate", 0.0, 0.0)
    assert [value for value in estimate.pose.covariance if value] == [1.0, 4.0, 9.0]


def test_a_goal_and_an_estimate_may_be_lifted(b: Bench) -> None:
    _, goal = use(b, "2D Goal Pose", 1.0, 2.0, 0.5)
    assert goal.pose.position.z == 0.5


def test_a_clicked_point_has_its_true_height(b: Bench) -> None:
    advertisement, point = use(b, "Publish Point", 1.0, 2.0, -0.75)
    assert advertisement == Advertisement("/clicked_point", "geometry_msgs/msg/PointStamped")
    assert (point.point.x, point.point.y, point.point.z) == (1.0, 2.0, -0.75)


def test_a_message_that_was_published_is_reported_with_its_values(b: Bench) -> None:
    messages: list[Any] = []
    statuses: list[Status] = []

    def published(*message: Any) -> None:
        messages.append(message)

    point = ((1.0, 2.0, 0.5),)
    b.viewer.enqueue(UseTool("Publish Point", point, report=statuses.append, published=published))
    b.turn()
    header = {"stamp": {"sec": 112, "nanosec": 345}, "frame_id": "map"}
    values = {"header": header, "point": {"x": 1.0, "y": 2.0, "z": 0.5}}
    assert messages == [("/clicked_point", "geometry_msgs/msg/PointStamped", values)]
    assert statuses == [Status(Level.OK, "Published to /clicked_point, 1 subscription.")]
