"""Faults of clocks and stamps."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable

import examining
import pytest
from builtin_interfaces.msg import Time
from examining import SCAN, three_ranges
from nodes import SpunNode, node_of
from rcl_interfaces.srv import SetParameters
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import LaserScan as LaserScanMessage

from webviz import Finding, Severity, Topic
from webviz.api.finding import CauseLevel
from webviz.api.offer import Offer, Publisher
from webviz.commands import Reset
from webviz.shell.testing.harness import Harness
from webviz.shell.testing.live import LiveViewer
from webviz.shell.testing.messages import header
from webviz.shell.testing.source import SECOND
from webviz_displays.laser_scan import LaserScan
from webviz_displays.odometry import Odometry
from webviz_displays.point_cloud2 import PointCloud2
from webviz_displays.tf import TF

WALL_NS = 1_700_000_000 * SECOND
SIMULATOR = Publisher("/simulator", "rosgraph_msgs/msg/Clock", "reliable", "volatile")
PLAYER = Publisher("/player", "rosgraph_msgs/msg/Clock", "reliable", "volatile")

Make = Callable[..., Harness]


@pytest.fixture
def stage(webviz_harness: Make) -> Harness:
    """A viewer on wall time."""
    stage = webviz_harness(LaserScan(), fixed_frame="map")
    stage.source.now = WALL_NS
    stage.turn()
    return stage


def examined(stage: Harness, seconds: float = 1.1) -> dict[str, Finding]:
    """The findings about time."""
    return examining.examined(stage, CauseLevel.TIME, seconds)


def scans(stage: Harness, stamp_ns: Callable[[int], int]) -> None:
    """Publish scans, stamped as a function of the time."""
    for _ in range(6):
        stage.source.now += SECOND // 4
        stage.clock += 0.25
        stage.publish("/scan", SCAN, three_ranges("map", stamp_ns(stage.source.now)))
        stage.turn()


@pytest.mark.parametrize(
    ("id", "stamp_ns"),
    [
        ("TIME004 /scan", lambda now: now - WALL_NS + SECOND),
        ("TIME006 /scan", lambda now: 0),
        ("TIME007 /scan", lambda now: WALL_NS),
        ("TIME008 /scan", lambda now: now + 5 * SECOND),
        ("TIME009 /scan", lambda now: now - 5 * SECOND),
        ("", lambda now: now - SECOND // 20),
    ],
)
def test_stamps(stage: Harness, id: str, stamp_ns: Callable[[int], int]) -> None:
    scans(stage, stamp_ns)
    assert [*examined(stage)] == ([id] if id else [])


def clocks(stage: Harness, *publishers: Publisher) -> None:
    """Let these nodes publish /clock."""
    stage.source.topics["/clock"] = Offer(publishers, None)
    stage.source.clock_count = 10


def standing(stage: Harness, rounds: int, at_ns: int | None = None) -> dict[str, Finding]:
    """The findings after some rounds in which ROS time stands."""
    stage.viewer.doctor.slice_s = math.inf
    for _ in range(rounds):
        stage.source.now = stage.source.now if at_ns is None else at_ns
        stage.clock += 1.1
        stage.turn()
        stage.state()
    return examining.by_key(stage.state().findings, CauseLevel.TIME)


def test_a_clock_that_is_missing_ends_or_is_there_twice(stage: Harness) -> None:
    clocks(stage)
    assert standing(stage, 1, 0) == {}  # it takes two rounds
    assert [*standing(stage, 5, 0)] == ["TIME001"]
    clocks(stage, SIMULATOR, PLAYER)
    assert [*examined(stage)] == ["TIME003"]
    clocks(stage, SIMULATOR)
    assert examined(stage) == {}
    clocks(stage)
    assert [*standing(stage, 6)] == ["TIME002"]


def causes(viewer: LiveViewer) -> dict[str, str]:
    """Causes in the graph, in time and in frames, in the order of the doctor, by id."""
    return {
        each.id: each.cause
        for each in viewer.viewer.snapshot().findings
        if each.severity > Severity.NOTE and each.id.startswith(("GRAPH", "TIME", "TF"))
    }


@pytest.mark.parametrize("is_followed", [False, True])
def test_a_clock_of_a_paused_simulator(
    webviz_domain: int, webviz_viewer: Callable[..., LiveViewer], is_followed: bool
) -> None:
    with node_of(webviz_domain, "gazebo") as node:
        clock = node.create_publisher(Clock, "/clock", 1)
        node.create_publisher(LaserScanMessage, "/scan", 1)
        viewer = webviz_viewer(LaserScan(topic=Topic("/scan")), fixed_frame="map")
        if is_followed:
            set_parameters = node.create_client(SetParameters, "/webviz/set_parameters")
            assert set_parameters.wait_for_service(60.0)
            parameter = Parameter("use_sim_time", value=True).to_parameter_msg()
            set_parameters.call_async(SetParameters.Request(parameters=[parameter]))

        def findings_since(step: int | None = 0) -> dict[str, str]:
            """The causes by id, after a message on /clock if `step` is given."""
            nonlocal time_s
            if step is not None:
                time_s += step
                clock.publish(Clock(clock=Time(sec=time_s)))
            return causes(viewer)

        time_s = 7
        missing = "TIME001" if is_followed else "TIME013"
        viewer.wait_for(
            lambda: [*findings_since(None)] == [missing],
            lambda: f"It found {findings_since(None)}.",
        )
        assert "othing has arrived on /clock from /gazebo" in findings_since(None)[missing]
        still = "Simulated time stands still at 7.0 s (/gazebo), so nodes with use_sim_time wait."
        viewer.wait_for(
            lambda: findings_since() == {"TIME013": still}, lambda: f"It found {findings_since()}."
        )
        # While time runs, the topic itself is to blame, and what publishes no transforms.
        viewer.wait_for(
            lambda: [*findings_since(1)][:1] == ["GRAPH008"],
            lambda: f"It found {findings_since()}.",
        )


def test_two_clocks_come_before_their_consequences(
    webviz_domain: int, webviz_viewer: Callable[..., LiveViewer]
) -> None:
    with node_of(webviz_domain, "gazebo") as one, node_of(webviz_domain, "player") as other:
        one.create_publisher(LaserScanMessage, "/scan", 1)
        for node in (one, other):
            node.create_publisher(Clock, "/clock", 1)
        viewer = webviz_viewer(LaserScan(topic=Topic("/scan")), fixed_frame="map")

        viewer.wait_for(
            lambda: [*causes(viewer)] == ["TIME003"], lambda: f"It found {causes(viewer)}."
        )


@pytest.mark.parametrize("follows", [True, False])
def test_nodes_that_wait_for_a_clock(
    webviz_domain: int, webviz_viewer: Callable[..., LiveViewer], follows: bool
) -> None:
    lidar = SpunNode(webviz_domain, "lidar")
    lidar.node.set_parameters([Parameter("use_sim_time", value=follows)])
    lidar.node.create_publisher(LaserScanMessage, "/scan", 1)
    viewer = webviz_viewer(LaserScan(topic=Topic("/scan")), fixed_frame="map")
    try:
        waits = "/lidar has use_sim_time, but nothing publishes /clock."
        first = {"TIME014": waits} if follows else {}
        lidar.until(
            lambda: (
                {i: c for i, c in causes(viewer).items() if i.startswith("TIME")} == first
                and ("GRAPH008" in causes(viewer)) != follows
            ),
            "the answer of the lidar",
        )
        if follows:
            assert [*causes(viewer)] == ["TIME014"]
    finally:
        lidar.close()


def test_a_node_on_wall_time(stage: Harness) -> None:
    clocks(stage, SIMULATOR)
    stage.source.now = 100 * SECOND
    stage.turn()
    scans(stage, lambda now: WALL_NS + now)
    assert [*examined(stage)] == ["TIME005 /scan"]


def test_transforms_of_another_clock(stage: Harness) -> None:
    for _ in range(3):
        stage.source.now += SECOND // 4
        stage.transform("map", "odom", stamp_ns=stage.source.now - 60 * SECOND)
        stage.turn()
    findings = examined(stage)
    assert [*findings] == ["TIME010"]
    assert [each.status for each in findings["TIME010"].explains] == ["Clocks"]


def test_a_transform_of_another_clock_has_no_finding_of_having_stopped(
    webviz_harness: Make,
) -> None:
    stage = webviz_harness(LaserScan(), TF(), fixed_frame="map")
    stage.source.now = WALL_NS
    stage.turn()
    stage.transform("base_link", "laser")

    def publish() -> None:
        now = stage.source.now
        stage.transform("map", "odom", stamp_ns=now)
        stage.transform("odom", "base_link", stamp_ns=now - 5 * SECOND)
        stage.publish("/scan", SCAN, three_ranges("laser", now))

    for _ in range(8):
        stage.findings(0.2, publish)
    first, *others = stage.findings(0.2, publish)
    assert first.id == "TIME010"
    assert not {each.id for each in others} & {"TIME011", "TF018", "TF020"}


@pytest.mark.parametrize(
    ("late_s", "ids"),
    [
        ({}, []),
        ({"/scan": 0.5}, ["TIME009 /scan"]),
        ({"/scan": -0.5}, ["TIME008 /scan"]),
        ({"/scan": 0.2}, []),  # a slow sweep
        ({"/cloud": 0.5}, []),  # takes time to compute
        ({"odom": 0.5}, ["TIME010"]),
        ({"map": -0.5}, []),  # localisation stamps ahead
        ({"/odom": 0.5, "odom": 0.5}, ["TIME010"]),
        ({"/scan": 0.5, "/odom": 0.5, "/cloud": 0.5, "odom": 0.5, "map": 0.0}, ["TIME010"]),
        ({"/scan": -0.5, "/odom": -0.5, "odom": -0.5, "map": -1.0}, ["TIME010"]),
    ],
)
@pytest.mark.parametrize("jitter_s", [0.02, 0.4])
def test_stamps_that_are_off_by_a_steady_half_second(
    webviz_harness: Make, late_s: dict[str, float], ids: list[str], jitter_s: float
) -> None:
    stage = webviz_harness(LaserScan(), Odometry(), PointCloud2(topic=Topic("/cloud")), TF())
    stage.source.now = WALL_NS
    stage.transform("base_link", "laser")
    waits, wait_s = itertools.cycle([0.0, jitter_s / 2, jitter_s, jitter_s / 2]), 0.0

    def stamp(name: str) -> int:
        return stage.source.now - round((late_s.get(name, 0.0) + wait_s) * SECOND)

    def publish() -> None:
        nonlocal wait_s
        for _ in range(3):
            wait_s = next(waits)
            stage.source.now += SECOND // 20
            stage.transform("map", "odom", stamp_ns=stamp("map"))
            stage.transform("odom", "base_link", (1.0, 0.0, 0.0), stamp_ns=stamp("odom"))
            stage.transform("base_link", "wheel", stamp_ns=stamp("odom"))
            stage.publish("/scan", SCAN, three_ranges("laser", stamp("/scan")))
            pose = {"position": {"x": 1.0}, "orientation": {"w": 1.0}}
            odometry = {"header": header("odom", stamp("/odom")), "pose": {"pose": pose}}
            stage.publish("/odom", "nav_msgs/msg/Odometry", odometry)
            cloud = {"header": header("laser", stamp("/cloud"))}
            stage.publish("/cloud", "sensor_msgs/msg/PointCloud2", cloud)

    for _ in range(4):
        stage.findings(0.3, publish)
    findings = examining.examined(stage, CauseLevel.TIME, 0.3, publish)
    assert [*findings] == (ids if jitter_s < 0.1 else [])


def test_data_and_transforms_of_two_clocks(stage: Harness) -> None:
    stage.transform("map", "base_link", stamp_ns=50 * SECOND)
    stage.transform("map", "base_link", stamp_ns=51 * SECOND)
    stage.publish("/scan", SCAN, {"header": header("base_link", stage.source.now)})
    stage.turn()
    assert "TIME011 base_link" in examined(stage)


def test_a_bag_that_started_again_beside_a_robot(stage: Harness) -> None:
    def publish(stamp_ns: int) -> None:
        stage.transform("map", "arm", stamp_ns=stage.source.now)
        stage.transform("map", "odom", stamp_ns=stamp_ns)
        stage.publish("/scan", SCAN, {"header": header("odom", stamp_ns)})

    for _ in range(5):
        stage.source.now += SECOND // 10
        publish(stage.source.now)
        stage.turn()
    findings = examining.examined(
        stage, CauseLevel.TIME, 0.5, lambda: publish(stage.source.now - 60 * SECOND)
    )
    assert "TIME012 odom" in findings
    stage.viewer.enqueue(Reset())
    assert "TIME012 odom" not in examining.examined(
        stage, CauseLevel.TIME, 0.5, lambda: publish(stage.source.now)
    )
