"""Faults of the ROS graph, provoked with real publishers."""

from __future__ import annotations

import contextlib
import re
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path as PathOfFile

import pytest
from examining import SCAN, display, examined, live_findings
from geometry_msgs.msg import PointStamped, PoseStamped
from nav_msgs.msg import OccupancyGrid
from nodes import node_of
from rclpy.duration import Duration
from rclpy.lifecycle import LifecycleNode
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import LaserScan

import webviz
import webviz.ros.node
from webviz.api.finding import CauseLevel
from webviz.api.offer import Offer, Publisher
from webviz.commands import SetProperty
from webviz.shell.doctor.examination import examine_live, live_config
from webviz.shell.live_source import ros_source
from webviz.shell.testing.harness import Harness
from webviz.shell.testing.live import LiveViewer
from webviz_displays.laser_scan import LaserScan as LaserScanDisplay
from webviz_displays.map import Map
from webviz_displays.path import Path
from webviz_displays.poses import Pose, PoseWithCovariance
from webviz_displays.tf import TF

BEST_EFFORT = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
POSE = "geometry_msgs/msg/PoseWithCovarianceStamped"
Viewers = Callable[..., LiveViewer]


@pytest.fixture
def robot(webviz_domain: int) -> Iterator[Node]:
    """A node that publishes nothing yet."""
    with node_of(webviz_domain, "robot") as node:
        yield node


def scan(topic: str, **policies: str) -> LaserScanDisplay:
    """A display of a scan, named after its topic."""
    return LaserScanDisplay(name=topic, topic=webviz.Topic(topic, **policies))  # pyright: ignore


def wait_for(viewer: LiveViewer, *ids: str) -> dict[str, webviz.Finding]:
    """Wait until exactly these findings are made, in this order."""
    viewer.wait_for(
        lambda: tuple(live_findings(viewer, CauseLevel.GRAPH)) == ids,
        lambda: f"It found {[*live_findings(viewer, CauseLevel.GRAPH)]}, not {[*ids]}.",
    )
    return live_findings(viewer, CauseLevel.GRAPH)


def test_every_fault_of_a_topic_has_its_own_finding(robot: Node, webviz_viewer: Viewers) -> None:
    robot.create_publisher(LaserScan, "/front/scan", BEST_EFFORT)
    robot.create_publisher(LaserScan, "/scan_rear", BEST_EFFORT)
    robot.create_publisher(LaserScan, "/plan", BEST_EFFORT)
    viewer = webviz_viewer(
        scan("/nothing_like_it"),
        scan("/scan_raer"),
        scan("/back/scan"),
        Path(topic=webviz.Topic("/plan")),
        scan("/front/scan", reliability="reliable"),
        scan("/scan_rear", durability="transient_local"),
        scan("/plan"),
    )
    findings = wait_for(
        viewer,
        "GRAPH002 /scan_raer",
        "GRAPH003 /back/scan",
        "GRAPH004 /plan",
        "GRAPH005 /front/scan",
        "GRAPH006 /scan_rear",
        "GRAPH010 /nothing_like_it",
    )
    misspelt = findings["GRAPH002 /scan_raer"]
    assert misspelt.cause == ("No node publishes /scan_raer, but /scan_rear has a similar name.")
    assert misspelt.explains == ((display(viewer, "/scan_raer"), "Topic"),)
    assert misspelt.button == (
        display(viewer, "/scan_raer"),
        webviz.Remedy("topic.name", "/scan_rear", "Use /scan_rear"),
    )


def test_a_remedy_ends_its_finding(robot: Node, webviz_viewer: Viewers) -> None:
    publisher = robot.create_publisher(LaserScan, "/scan", BEST_EFFORT)
    viewer = webviz_viewer(scan("/scan", reliability="reliable"))
    findings = wait_for(viewer, "GRAPH005 /scan")
    change = findings["GRAPH005 /scan"].button
    assert isinstance(change, webviz.ChangeDisplay)
    viewer.viewer.enqueue(SetProperty(change.display, change.remedy.path, change.remedy.value))
    wait_for(viewer, "GRAPH008 /scan")
    message = LaserScan()
    message.header.frame_id = "map"
    viewer.wait_for(publisher.get_subscription_count)
    publisher.publish(message)
    wait_for(viewer)
    robot.destroy_publisher(publisher)
    wait_for(viewer, "GRAPH011 /scan")


def test_a_robot_in_another_namespace_is_one_finding(robot: Node, webviz_viewer: Viewers) -> None:
    for topic in ("/robot1/scan", "/robot1/rear"):
        robot.create_publisher(LaserScan, topic, BEST_EFFORT)
    viewer = webviz_viewer(scan("/scan"), scan("/rear"))
    both = wait_for(viewer, "GRAPH003 /scan")["GRAPH003 /scan"]
    assert both.cause == "No node publishes /scan, /rear, but they are published in /robot1."
    assert both.command == "webviz --ros-args -r __ns:=/robot1"
    assert len(both.explains) == 2


def test_topics_of_a_node_that_ended_are_one_finding(
    robot: Node, webviz_domain: int, webviz_viewer: Viewers
) -> None:
    viewer = webviz_viewer(scan("/front"), scan("/rear"), fixed_frame="map")
    message = LaserScan(ranges=[1.0], range_max=2.0)
    message.header.frame_id = "map"
    with node_of(webviz_domain, "lidars") as lidars:
        publishers = [lidars.create_publisher(LaserScan, each, 1) for each in ("/front", "/rear")]

        def is_received() -> bool:
            """Return whether both topics have a message; the first may come before its match."""
            for each in publishers:
                each.publish(message)
            topics = [row.statuses.get("Topic") for row in viewer.viewer.snapshot().rows]
            return all(each and each.level is webviz.Level.OK for each in topics)

        viewer.wait_for(is_received)

        def are_named() -> bool:
            offers = viewer.source.offers()
            return all(p.node for each in ("/front", "/rear") for p in offers[each].publishers)

        viewer.wait_for(are_named)  # DDS tells the names of nodes somewhat later
        rounds = viewer.viewer.doctor.rounds
        viewer.wait_for(lambda: viewer.viewer.doctor.rounds > rounds + 1)
    text = "/lidars has left the graph, so /front, /rear no longer have a publisher."

    def causes() -> list[str]:
        """Causes by now: publishers and their node need not leave in one look at the graph."""
        return [each.cause for each in live_findings(viewer, CauseLevel.GRAPH).values()]

    viewer.wait_for(lambda: causes() == [text], lambda: f"It found {causes()}.")


def test_a_publisher_without_messages_is_a_note(robot: Node, webviz_viewer: Viewers) -> None:
    robot.create_publisher(PoseStamped, "/goal_pose", 1)
    viewer = webviz_viewer(Pose(topic=webviz.Topic("/goal_pose")))

    def findings_on_graph() -> list[tuple[str, webviz.Severity]]:
        return [
            (each.id, each.severity)
            for each in viewer.viewer.snapshot().findings
            if each.level is CauseLevel.GRAPH
        ]

    viewer.wait_for(
        lambda: findings_on_graph() == [("GRAPH008", webviz.Severity.NOTE)],
        lambda: f"{findings_on_graph()}",
    )


def test_a_silent_publisher_is_blamed_for_no_more_than_is_known(
    robot: Node, webviz_viewer: Viewers
) -> None:
    maps = robot.create_publisher(OccupancyGrid, "/map", 1)
    maps.publish(OccupancyGrid())  # before webviz listens
    viewer = webviz_viewer(Map(topic=webviz.Topic("/map")))
    findings = wait_for(viewer, "GRAPH008 /map")["GRAPH008 /map"]
    words = re.compile(
        r"Nothing has arrived on /map from /robot since webviz began to listen \S+ m?s ago\."
    )
    assert words.fullmatch(findings.cause)
    assert findings.remedy.endswith(
        "Let it publish as transient local if it sent a message earlier."
    )
    waited = findings.evidence["silent_s"]

    def is_longer() -> bool:
        now = live_findings(viewer, CauseLevel.GRAPH)["GRAPH008 /map"].evidence["silent_s"]
        return now > waited  # pyright: ignore[reportOperatorIssue]

    viewer.wait_for(is_longer)


def test_tools_of_webviz_are_not_accused(webviz_domain: int, webviz_viewer: Viewers) -> None:
    with node_of(webviz_domain, "webviz") as other, node_of(webviz_domain, "robot") as robot:
        other.create_publisher(PoseStamped, "/goal_pose", 1)
        robot.create_publisher(PoseStamped, "/pose", 1)
        viewer = webviz_viewer(
            Pose(topic=webviz.Topic("/goal_pose")), Pose(topic=webviz.Topic("/pose"))
        )

        def silent() -> set[str]:
            findings = viewer.viewer.snapshot().findings
            return {each.subject for each in findings if each.id == "GRAPH008"}

        viewer.wait_for(lambda: silent() == {"/pose"}, lambda: f"{silent()}")
        displays = live_config(viewer.source.offers()).displays
        assert [each.topic.name for each in displays if isinstance(each, Pose)] == ["/pose"]


def test_topics_that_are_found_late_are_examined_too(robot: Node) -> None:
    def progress(doing: str, share: float) -> None:
        if doing == "examining" and not robot.count_publishers("/late"):
            robot.create_publisher(PoseStamped, "/late", 1)

    robot.create_publisher(PoseStamped, "/pose", 1)
    with contextlib.closing(ros_source()) as source:
        report = examine_live(source, None, time.monotonic() + 12.0, progress)
    assert report.displays == len(("Grid", "/pose", "/late"))


@pytest.mark.parametrize(
    ("name", "value"),
    [("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST"), ("ROS_LOCALHOST_ONLY", "1")],
)
def test_a_graph_without_any_other_node(
    webviz_domain: int,
    tmp_path: PathOfFile,
    monkeypatch: pytest.MonkeyPatch,
    name: str,
    value: str,
) -> None:
    config = tmp_path / "lab.yaml"
    config.write_text("displays: [{type: LaserScan}]")

    def first(*ids: str) -> webviz.Finding:
        """Wait until one of these is the first finding above the network's."""
        while True:  # the graph is read every two seconds
            results = [each for each in viewer.doctor() if not each.id.startswith(("NET", "SHM"))]
            if results and results[0].id in ids:
                return results[0]

    with webviz.Viewer(config, port=0) as viewer:
        # The node stays on this machine; the doctor reads variables anew.
        monkeypatch.delenv("ROS_AUTOMATIC_DISCOVERY_RANGE")
        empty = first("GRAPH001")
        assert [each.status for each in empty.explains[:2]] == ["Topic", "Fixed Frame"]
        monkeypatch.setenv(name, value)
        limited = first("ENV016")
        assert limited.cause == (
            f"{name} is {value}, so nodes of other machines are not found, and none of this "
            f"machine is visible in domain {webviz_domain}."
        )
        assert limited.command == f"unset {name}"
        assert limited.explains == empty.explains
        assert "GRAPH001" not in {each.id for each in viewer.doctor()}
        with node_of(webviz_domain, "_ros2cli_daemon"):  # shows nothing about the robot
            while "/_ros2cli_daemon" not in str(first("ENV016").evidence["nodes"]):
                pass
        with node_of(webviz_domain, "robot"):
            while {"ENV016", "GRAPH001"} & {each.id for each in viewer.doctor()}:
                pass
            (missing,) = [each for each in viewer.doctor() if each.id == "GRAPH010"]
            assert missing.remedy.endswith(f"With {name}, those of other machines are not found.")


def test_messages_above_the_limit(
    robot: Node, webviz_viewer: Viewers, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(webviz.ros.node, "MAX_MESSAGE", 1000)
    publisher = robot.create_publisher(LaserScan, "/scan", 1)
    viewer = webviz_viewer(scan("/scan"))
    viewer.wait_for(publisher.get_subscription_count)
    message = LaserScan(ranges=[1.0] * 1000)
    message.header.frame_id = "map"

    def findings_on_graph() -> dict[str, webviz.Finding]:
        publisher.publish(message)  # the first ones may be lost
        return live_findings(viewer, CauseLevel.GRAPH)

    viewer.wait_for(lambda: "GRAPH007 /scan" in findings_on_graph())
    assert findings_on_graph()["GRAPH007 /scan"].remedy == "Publish smaller messages."
    message.ranges = [1.0] * 10
    viewer.wait_for(lambda: not findings_on_graph())


def test_a_deadline_that_no_publisher_offers(robot: Node, webviz_viewer: Viewers) -> None:
    slow, quick = (QoSProfile(depth=1, deadline=Duration(seconds=s)) for s in (1.0, 0.1))
    publisher = robot.create_publisher(PoseStamped, "/pose", slow)
    listener = robot.create_subscription(PoseStamped, "/pose", print, quick)
    viewer = webviz_viewer(TF())
    wait_for(viewer, "GRAPH014 /pose")
    cause = (
        "/robot receives nothing on /pose: it asks for a deadline of 0.1 s, and /robot offers 1 s."
    )
    # DDS tells the names of nodes somewhat later than their endpoints.
    viewer.wait_for(
        lambda: live_findings(viewer, CauseLevel.GRAPH)["GRAPH014 /pose"].cause == cause,
        lambda: f"It found {live_findings(viewer, CauseLevel.GRAPH)}.",
    )
    robot.destroy_publisher(publisher)
    publisher = robot.create_publisher(PoseStamped, "/pose", quick)
    wait_for(viewer)
    robot.destroy_publisher(publisher)
    robot.create_publisher(PoseStamped, "/pose", 1)
    findings = wait_for(viewer, "GRAPH014 /pose")["GRAPH014 /pose"]
    assert findings.cause.endswith("/robot offers none.")
    robot.destroy_subscription(listener)
    wait_for(viewer)


RELIABLE, LATCHED, VOLATILE = (
    QoSProfile(depth=1, durability=durability)
    for durability in (
        DurabilityPolicy.SYSTEM_DEFAULT,
        DurabilityPolicy.TRANSIENT_LOCAL,
        DurabilityPolicy.VOLATILE,
    )
)


@pytest.mark.parametrize(
    ("offered", "requested", "cured", "words"),
    [
        (BEST_EFFORT, RELIABLE, BEST_EFFORT, ("reliable", "best effort", "best effort")),
        (VOLATILE, LATCHED, VOLATILE, ("transient local", "volatile", "as volatile")),
    ],
)
def test_a_node_whose_qos_does_not_match(
    robot: Node,
    webviz_domain: int,
    webviz_viewer: Viewers,
    offered: QoSProfile,
    requested: QoSProfile,
    cured: QoSProfile,
    words: tuple[str, str, str],
) -> None:
    robot.create_publisher(LaserScan, "/scan", offered)
    viewer = webviz_viewer(TF())
    with node_of(webviz_domain, "student") as student:
        asking = student.create_subscription(LaserScan, "/scan", print, requested)
        wait_for(viewer, "GRAPH016 /scan")
        request, offer, remedy = words
        cause = f"/student cannot receive /scan from /robot: requested {request}, offered {offer}."
        viewer.wait_for(
            lambda: live_findings(viewer, CauseLevel.GRAPH)["GRAPH016 /scan"].cause == cause,
            lambda: f"It found {live_findings(viewer, CauseLevel.GRAPH)}.",
        )
        findings = live_findings(viewer, CauseLevel.GRAPH)["GRAPH016 /scan"]
        assert findings.remedy.startswith("Let /student subscribe ")
        assert remedy in findings.remedy
        assert findings.remedy.endswith(f"or let /robot publish as {request}.")
        other = student.create_publisher(LaserScan, "/scan", requested)
        viewer.wait_for(  # which serves the subscription, and not from the other one
            lambda: noted(viewer).get("GRAPH016") is webviz.Severity.NOTE,
            lambda: f"{noted(viewer)}",
        )
        student.destroy_publisher(other)
        student.destroy_subscription(asking)
        student.create_subscription(LaserScan, "/scan", print, cured)
        wait_for(viewer)


def test_a_node_that_was_started_twice(robot: Node, webviz_viewer: Viewers) -> None:
    lidars = [Node("lidar", context=robot.context, enable_rosout=False) for _ in range(2)]
    viewer = webviz_viewer(TF())
    viewer.wait_for(lambda: noted(viewer) == {"GRAPH015": webviz.Severity.NOTE})
    for node in lidars:
        node.create_publisher(LaserScan, "/scan", 1)
    findings = wait_for(viewer, "GRAPH015 /lidar")["GRAPH015 /lidar"]
    assert findings.cause == "2 nodes have the name /lidar, and publish /scan."
    lidars[0].destroy_node()
    viewer.wait_for(lambda: not noted(viewer))
    lidars[1].destroy_node()


def test_two_viewers_and_one_beside_a_doctor(robot: Node, webviz_viewer: Viewers) -> None:
    other = Node("webviz", context=robot.context, enable_rosout=False)
    viewer = webviz_viewer(TF())
    viewer.wait_for(lambda: [*viewer.source.graph.nodes()].count("/webviz") == 2)
    assert "GRAPH015" not in noted(viewer)
    other.create_publisher(PointStamped, "/clicked_point", 1)
    viewer.wait_for(lambda: noted(viewer).get("GRAPH015") is webviz.Severity.NOTE)
    (finding,) = (each for each in viewer.viewer.snapshot().findings if each.id == "GRAPH015")
    assert finding.cause == "2 viewers have the name /webviz."
    assert "--ros-args -r __ns:=" in finding.command
    other.destroy_node()
    viewer.wait_for(lambda: "GRAPH015" not in noted(viewer))


def test_large_messages_that_are_not_repeated(robot: Node, webviz_viewer: Viewers) -> None:
    viewer = webviz_viewer(scan("/scan"))
    publisher = robot.create_publisher(LaserScan, "/scan", BEST_EFFORT)
    message = LaserScan(ranges=[1.0] * 150_000)
    message.header.frame_id = "map"

    def findings_on_graph() -> dict[str, webviz.Severity]:
        publisher.publish(message)  # some may be lost
        return {id: severity for id, severity in noted(viewer).items() if id == "NET013"}

    viewer.wait_for(findings_on_graph)
    message.ranges = [1.0] * 100
    viewer.wait_for(lambda: not findings_on_graph())


def noted(viewer: LiveViewer) -> dict[str, webviz.Severity]:
    """The findings on graph and network, notes too, by id."""
    levels = CauseLevel.GRAPH, CauseLevel.NETWORK
    findings = viewer.viewer.snapshot().findings
    own = {"NET003", "NET004", "NET005", "NET006"}  # of the machine on which the tests run
    return {
        each.id: each.severity for each in findings if each.level in levels and each.id not in own
    }


def test_a_publisher_that_stops(webviz_harness: Callable[..., Harness]) -> None:
    stage = webviz_harness(scan("/scan"), fixed_frame="map")
    stage.source.topics["/scan"] = Offer((Publisher("/lidar", SCAN, "reliable", "volatile"),), None)

    def publish() -> None:
        stage.publish("/scan", SCAN, {"ranges": [2.0], "range_max": 10.0}, frame="map")

    assert examined(stage, CauseLevel.GRAPH, 0.2, publish) == {}
    (finding,) = examined(stage, CauseLevel.GRAPH).values()
    assert (finding.id, finding.subject) == ("GRAPH009", "/scan")
    assert finding.cause == (
        "Nothing has arrived on /scan from /lidar for 4.4 s, previously at 5.0 Hz."
    )
    assert examined(stage, CauseLevel.GRAPH, 0.2, publish) == {}


def test_topics_that_stop_together_are_one_finding(webviz_harness: Callable[..., Harness]) -> None:
    stage = webviz_harness(scan("/front"), scan("/rear"), fixed_frame="map")
    for topic in ("/front", "/rear"):
        offered = Publisher(f"{topic}_lidar", SCAN, "reliable", "volatile")
        stage.source.topics[topic] = Offer((offered,), None)

    def publish(*topics: str) -> None:
        for topic in topics:
            stage.publish(topic, SCAN, {"ranges": [2.0], "range_max": 10.0}, frame="map")

    assert examined(stage, CauseLevel.GRAPH, 0.2, partial(publish, "/front", "/rear")) == {}
    (finding,) = [each for each in stage.findings(0.2) if each.level is CauseLevel.GRAPH]
    assert finding.cause.startswith(
        "Nothing has arrived on /front, /rear from /front_lidar, /rear_lidar for "
    )
    assert len(finding.explains) == 2


def test_a_pose_that_is_sent_while_the_robot_moves(webviz_harness: Callable[..., Harness]) -> None:
    stage = webviz_harness(PoseWithCovariance(topic=webviz.Topic("/amcl_pose")), fixed_frame="map")
    offered = Publisher("/amcl", POSE, "reliable", "volatile")
    stage.source.topics["/amcl_pose"] = Offer((offered,), None)
    values = {"pose": {"pose": {"orientation": {"w": 1.0}}}}
    publish_pose = partial(stage.publish, "/amcl_pose", POSE, values, frame="map")
    examined(stage, CauseLevel.GRAPH, 0.2, publish_pose)
    assert examined(stage, CauseLevel.GRAPH) == {}
    (finding,) = [each for each in stage.viewer.snapshot().findings if each.id == "GRAPH009"]
    assert finding.severity is webviz.Severity.NOTE


def test_a_lifecycle_node_that_is_not_active(webviz_domain: int, webviz_viewer: Viewers) -> None:
    with node_of(webviz_domain, "lidar", LifecycleNode) as node:
        publisher = node.create_lifecycle_publisher(LaserScan, "/scan", 1)
        node.trigger_configure()
        viewer = webviz_viewer(scan("/scan"))
        findings = wait_for(viewer, "GRAPH012 /scan")
        assert findings["GRAPH012 /scan"].command == "ros2 lifecycle get /lidar"
        node.trigger_activate()
        message = LaserScan(ranges=[1.0])
        message.header.frame_id = "map"

        def is_well() -> bool:
            publisher.publish(message)
            return not live_findings(viewer, CauseLevel.GRAPH)

        viewer.wait_for(is_well)
