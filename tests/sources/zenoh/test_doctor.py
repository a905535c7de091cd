"""Zenoh as the doctor and the command line meet it."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from nodes import node_of
from sensor_msgs.msg import LaserScan
from waiting import until
from zenoh_robot import BridgedRobot, ZenohRobot, ZenohRouter, free_port

from webviz.shell.cli import main

SCAN = "sensor_msgs/msg/LaserScan"
ODOMETRY = "nav_msgs/msg/Odometry"
TWIST = "geometry_msgs/msg/Twist"
RANGES = {
    "header": {"frame_id": "laser", "stamp": {"sec": 1}},
    "angle_max": 1.0,
    "angle_increment": 0.1,
    "range_max": 10.0,
    "ranges": [1.0] * 10,
}


Examine = Callable[..., Mapping[str, Mapping[str, Any]]]


@pytest.fixture
def examine(capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Examine:
    """Run `webviz doctor` until it makes a finding; return its first finding, and that by ids."""
    monkeypatch.setenv("ROS_DOMAIN_ID", "0")

    def run(*arguments: str, until_found: str = "", seconds: float = 6) -> Any:
        result: dict[str, Any] = {}

        def is_found() -> bool:
            main(["doctor", *arguments, "--json", "--seconds", str(seconds)])
            findings = json.loads(capfd.readouterr().out)["findings"]
            result.clear()
            result.update({each["id"]: each for each in reversed(findings)})
            result["first"] = findings[0] if findings else {}
            return until_found in result

        until(is_found, lambda: result)
        return result

    return run


@contextmanager
def repeated(*publications: tuple[Callable[..., None], object]) -> Iterator[None]:
    """Publish messages, again and again."""
    is_over = threading.Event()

    def run() -> None:
        while not is_over.wait(0.1):
            for publish, values in publications:
                publish(values)

    thread = threading.Thread(target=run)
    thread.start()
    try:
        yield
    finally:
        is_over.set()
        thread.join()


def test_no_router(examine: Examine) -> None:
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    result = examine("--connect", endpoint, until_found="NET007", seconds=2.5)
    assert result["first"]["cause"].startswith(
        f"{endpoint} is not connected. Nothing listens on 127.0.0.1:"
    )
    assert result["first"]["command"] == "ros2 run rmw_zenoh_cpp rmw_zenohd"


def test_the_domain_of_the_robot(router: ZenohRouter, examine: Examine) -> None:
    robot = ZenohRobot(router.endpoint, domain=7)
    result = examine("--connect", router.endpoint, until_found="NET014")
    assert result["first"]["cause"] == (
        "ROS_DOMAIN_ID 0 has no nodes on this network, but 7 has 1 node."
    )
    assert result["first"]["remedy"] == "Start webviz with ROS_DOMAIN_ID=7."
    assert "NET008" not in result
    robot.close()


def test_a_router_without_nodes(router: ZenohRouter, examine: Examine, tmp_path: Path) -> None:
    config = tmp_path / "scan.yaml"
    config.write_text("displays: [{type: LaserScan, topic: /scan}]\n")
    result = examine(
        "--connect", router.endpoint, "-d", str(config), until_found="GRAPH001", seconds=8
    )
    assert result["first"]["cause"] == (
        f"No other ROS node is visible on the Zenoh router {router.endpoint}."
    )
    assert "RMW_IMPLEMENTATION=rmw_zenoh_cpp" in result["first"]["remedy"]
    assert "multicast" not in result["first"]["command"]


def test_another_version_of_a_type(
    router: ZenohRouter, robot: ZenohRobot, examine: Examine
) -> None:
    publish = robot.publisher("/scan", SCAN, hash=f"RIHS01_{'ab' * 32}")
    with repeated((publish, RANGES)):
        result = examine("--connect", router.endpoint, until_found="NET014")
    assert result["first"]["cause"].startswith(
        "The publishers of /scan have another version of its type than this machine"
    )
    assert result["first"]["remedy"] == "Source the workspace of the robot."


@pytest.mark.parametrize("hash", [f"RIHS01_{'cd' * 32}", "TypeHashNotSupported"])
def test_nodes_of_two_distributions(
    router: ZenohRouter, robot: ZenohRobot, examine: Examine, hash: str
) -> None:
    """Zenoh passes nothing between them, and neither reports it."""
    steering = ZenohRobot(router.endpoint, "/joystick")
    steering.publisher("/cmd_vel", TWIST)
    robot.token("MS", "/cmd_vel", TWIST, hash=hash)
    result = examine("--connect", router.endpoint, until_found="NET014")
    assert result["first"]["cause"] == (
        "Publishers and subscriptions of /cmd_vel have different versions of its type, so nothing "
        "passes between them."
    )
    assert "the same ROS distribution" in result["first"]["remedy"]
    robot.subscription("/cmd_vel", TWIST)
    steering.close()


def test_a_bridge_that_routes_nothing(router: ZenohRouter, examine: Examine) -> None:
    bridge = BridgedRobot(router.endpoint, "robot1")
    result = examine("--connect", router.endpoint, until_found="NET014")
    assert result["first"]["cause"] == "A zenoh-bridge-ros2dds routes nothing."
    assert "`allow` and `deny`" in result["first"]["remedy"]
    bridge.close()


def test_a_bridge_whose_nodes_are_unknown(router: ZenohRouter, examine: Examine) -> None:
    bridge = BridgedRobot(router.endpoint, "robot1")
    with repeated((bridge.publisher("/scan", SCAN), RANGES)):
        result = examine("--connect", router.endpoint, until_found="TF001")
    assert not {"GRAPH001", "NET014"} & set(result)
    bridge.close()


def test_two_bridges_of_one_robot(router: ZenohRouter, examine: Examine) -> None:
    bridges = [BridgedRobot(router.endpoint) for _ in range(2)]
    publish = [bridge.publisher("/scan", SCAN) for bridge in bridges]
    with repeated(*((each, RANGES) for each in publish)):
        result = examine("--connect", router.endpoint, until_found="NET014")
    assert result["first"]["cause"] == (
        "Each message on /scan may come twice, through two zenoh-bridge-ros2dds."
    )
    for bridge in bridges:
        bridge.close()


def test_rmw_zenoh_and_a_bridge(router: ZenohRouter, robot: ZenohRobot, examine: Examine) -> None:
    bridge = BridgedRobot(router.endpoint)
    direct, through = robot.publisher("/scan", SCAN), bridge.publisher("/scan", SCAN)
    with repeated((direct, RANGES), (through, RANGES)):
        result = examine("--connect", router.endpoint, until_found="NET014")
    assert result["first"]["cause"].startswith("Two ways lead to one robot: /scan come over")
    assert result["first"]["remedy"] == "Stop the bridge; webviz reads rmw_zenoh only."
    bridge.close()


def test_tokens_without_data(examine: Examine) -> None:
    """The router passes on the graph but, by its access control, no message."""
    router = ZenohRouter(
        access_control={
            "enabled": True,
            "default_permission": "allow",
            "rules": [
                {
                    "id": "data",
                    "permission": "deny",
                    "flows": ["egress"],
                    "messages": ["put"],
                    "key_exprs": ["**"],
                }
            ],
            "subjects": [{"id": "everybody"}],
            "policies": [{"rules": ["data"], "subjects": ["everybody"]}],
        }
    )
    robot = ZenohRobot(router.endpoint)
    scan, odometry = robot.publisher("/scan", SCAN), robot.publisher("/odom", ODOMETRY)
    with repeated((scan, RANGES), (odometry, {"header": {"frame_id": "odom"}})):
        result = examine("--connect", router.endpoint, until_found="NET015")
    assert result["first"]["cause"] == (
        f"{router.endpoint} announces /odom, /scan, but passes on no message."
    )
    assert "`access_control`" in result["first"]["remedy"]
    assert "GRAPH008" not in result
    robot.close()
    router.close()


def test_one_silent_topic_is_of_its_node(
    router: ZenohRouter, robot: ZenohRobot, examine: Examine
) -> None:
    robot.publisher("/odom", ODOMETRY)
    with repeated((robot.publisher("/scan", SCAN), RANGES)):
        result = examine("--connect", router.endpoint, until_found="GRAPH008")
    assert result["GRAPH008"]["cause"].startswith("Nothing has arrived on /odom from /robot")
    assert "access_control" in result["GRAPH008"]["remedy"]
    assert "NET015" not in result


def test_dds_and_zenoh_at_once(
    router: ZenohRouter,
    robot: ZenohRobot,
    examine: Examine,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    webviz_domain: int,
) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", str(webviz_domain))
    config = tmp_path / "robots.yaml"
    config.write_text(
        f"robots: [{{namespace: robot1, connection: {router.endpoint}, domain: 0}}]\n"
        "displays: [{type: LaserScan, topic: /robot1/scan}]\n"
    )
    with (
        node_of(webviz_domain, "driver") as driver,
        repeated((robot.publisher("/scan", SCAN), RANGES)),
    ):
        driver.create_publisher(LaserScan, "/robot1/scan", 10)
        result = examine("-d", str(config), until_found="NET016", seconds=8)
    assert result["NET016"]["cause"].startswith(
        f"Two ways lead to robot1: others publish /robot1/scan here, besides its connection "
        f"{router.endpoint}"
    )
    assert result["NET016"]["remedy"].startswith("Remove the connection of robot1")


@pytest.mark.parametrize(
    ("arguments", "error"),
    [
        (["frames", "--connect", "tcp/robot"], "'tcp/robot' is not an address of Zenoh."),
        (["frames", "--connect", "none.json5"], "none.json5 with the config of Zenoh is not a"),
        (
            ["frames", "--connect", "tcp/r:1", "--ros-args", "-p", "use_sim_time:=true"],
            "is not supported with Zenoh",
        ),
    ],
)
def test_wrong_arguments_are_explained(
    arguments: list[str], error: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(arguments) in (1, 2)
    assert error in capsys.readouterr().err
