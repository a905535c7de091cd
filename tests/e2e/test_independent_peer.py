"""Somebody else's DDS stack drives the viewer: Eclipse Cyclone DDS, without ROS."""

from __future__ import annotations

import functools
import os
import signal
import subprocess
import sys
import time
import venv
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from pages import COARSE
from program import Program
from side import Side

import webviz
from webviz.shell.pictures.browser import Page

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install ros-webviz[ros]")

ROOT = Path(__file__).parents[2]
PEER = ROOT.parent / "shared" / "tools" / "cyclone_peer.py"
CONFIG = """\
fixed_frame: map
view: {distance: 16.0, yaw: -1.570796, pitch: 1.5697}
displays:
- {type: Map, alpha: 1.0}
- {type: LaserScan, size: 0.1, color_transformer: FlatColor, color: [255, 0, 255]}
- {type: Path, line_style: Billboards, line_width: 0.2, color: [255, 255, 0]}
- {type: TF}
- {type: Odometry}
panels:
- {type: Joints}
"""
ROBOT = """
<robot name="rail"><link name="base"/><link name="cart"/>
<joint name="slide" type="prismatic"><parent link="base"/><child link="cart"/>
<limit lower="0.25" upper="0.75" effort="1" velocity="1"/></joint></robot>
"""

PATIENCE_S = 60.0
SENT = {
    "goal_pose": ("g", r"PoseStamped\(header=Header\(.*frame_id='map'\).*z=0\.0"),
    "initialpose": ("p", r"PoseWithCovarianceStamped\(header=Header\(.*frame_id='map'\).*0\.25, "),
    "clicked_point": ("u", r"PointStamped\(header=Header\(.*frame_id='map'\).*z=0\.0"),
}
"""By topic, the key of a tool and what the peer hears of it."""


@pytest.fixture(scope="module")
def peer_python() -> str:
    """A Python with Cyclone DDS and nothing of ours."""
    if not PEER.exists():
        pytest.skip("the independent peer is not here: ../shared/tools/cyclone_peer.py")
    folder = ROOT / ".venv-peer"
    python = folder / "bin" / "python"
    if not python.exists():
        venv.create(folder, with_pip=True)
    installed = subprocess.run([python, "-c", "import cyclonedds"], capture_output=True)
    if installed.returncode:
        command = [python, "-m", "pip", "install", "--quiet", "cyclonedds==11.0.1"]
        if subprocess.run(command).returncode:
            pytest.skip("cyclonedds could not be installed")
    return str(python)


@pytest.fixture
def domain(webviz_domain: int) -> str:
    return str(webviz_domain)


@pytest.fixture
def peer(peer_python: str, domain: str, tmp_path: Path) -> Iterator[Program]:
    # The wheels of rclpy mark the environment of child processes, which are not theirs here.
    env = {k: v for k, v in os.environ.items() if k != "_ROS_WHEELS_BOOTSTRAP_COMPLETE"}
    command = [peer_python, str(PEER), "pub", "all", "--seconds", "120", "--domain", domain]
    program = Program(command, env, tmp_path / "peer.txt")
    yield program
    program.end(signal.SIGTERM)


@pytest.fixture
def echo(peer_python: str, domain: str, tmp_path: Path) -> Iterator[Program]:
    """Return the messages of tools that the peer receives."""
    env = {k: v for k, v in os.environ.items() if k != "_ROS_WHEELS_BOOTSTRAP_COMPLETE"}
    command = [peer_python, "-u", str(PEER), "echo", *SENT]
    program = Program(
        [*command, "joint_states", "--seconds", "120", "--domain", domain],
        env,
        tmp_path / "echo.txt",
    )
    yield program
    program.end(signal.SIGTERM)


@pytest.fixture
def describing(peer_python: str, domain: str, tmp_path: Path) -> Iterator[Program]:
    """The peer publishes the description of a robot."""
    urdf = tmp_path / "robot.urdf"
    urdf.write_text(ROBOT)
    env = {k: v for k, v in os.environ.items() if k != "_ROS_WHEELS_BOOTSTRAP_COMPLETE"}
    command = [peer_python, str(PEER), "pub", "robot_description", "--urdf", str(urdf)]
    program = Program(
        [*command, "--seconds", "120", "--domain", domain], env, tmp_path / "describing.txt"
    )
    yield program
    program.end(signal.SIGTERM)


@pytest.fixture
def url(domain: str, tmp_path: Path) -> Iterator[str]:
    config = tmp_path / "peer.yaml"
    config.write_text(CONFIG)
    env = {**os.environ, "ROS_DOMAIN_ID": domain, "PYTHONUNBUFFERED": "1"}
    # With this, rclpy announces itself to other processes in a way that only Fast DDS looks for.
    env.pop("ROS_AUTOMATIC_DISCOVERY_RANGE", None)
    command = [sys.executable, "-m", "webviz", "-d", str(config), "--port", "0"]
    program = Program(command, env, tmp_path / "viewer.txt")
    yield program.url()
    assert program.end() == 0, program.output()


def count(page: Page, rgb: tuple[int, int, int]) -> int:
    """Pixels of about one colour."""
    page.draw()
    return int((np.abs(page.pixels().astype(int) - rgb).max(axis=2) < 40).sum())


SILENT = """
import sys, time
sys.path.insert(0, sys.argv[1])
from cyclone_peer import SENSOR, DataWriter, DomainParticipant, LaserScan, Topic
participant = DomainParticipant(int(sys.argv[2]))
writer = DataWriter(participant, Topic(participant, "rt/scan", LaserScan), qos=SENSOR)
time.sleep(120)
"""


def test_a_program_without_a_node_that_sends_nothing(
    peer_python: str, domain: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    env = {k: v for k, v in os.environ.items() if k != "_ROS_WHEELS_BOOTSTRAP_COMPLETE"}
    command = [peer_python, "-c", SILENT, str(PEER.parent), domain]
    # With this, rclpy announces itself to other processes in a way that only Fast DDS looks for.
    monkeypatch.delenv("ROS_AUTOMATIC_DISCOVERY_RANGE", raising=False)
    config = tmp_path / "scan.yaml"
    config.write_text("fixed_frame: map\ndisplays: [{type: LaserScan}]\n")
    with webviz.Viewer(config, port=0) as viewer:

        def wait_until(is_found: bool) -> None:
            until = time.monotonic() + PATIENCE_S
            while ("GRAPH013" in {each.id for each in viewer.doctor()}) != is_found:
                assert time.monotonic() < until, [each.cause for each in viewer.doctor()]

        program = Program(command, env, tmp_path / "silent.txt")
        wait_until(True)
        program.end(signal.SIGTERM)
        wait_until(False)


def test_it_sees_everything_the_peer_publishes(
    peer: Program, url: str, open_page: Callable[..., Page]
) -> None:
    page = open_page(url)
    page.hold()
    page.wait_for(lambda: count(page, (255, 0, 255)) > 300, "the scan", 60)
    page.wait_for(lambda: count(page, (255, 255, 0)) > 100, "the path")
    page.wait_for(lambda: count(page, (255, 255, 255)) > 10_000, "the map")
    page.wait_for(lambda: page.tab.locator(".wv-tree [data-level=error]").count() == 0, "no error")
    side = Side(page)
    side.select("LaserScan")
    side.wait_for("from a DDS program (best effort, volatile)")


def test_the_peer_receives_what_tools_and_sliders_send_from_the_page(
    echo: Program, describing: Program, url: str, open_page: Callable[..., Page]
) -> None:
    page = open_page(url, resolution=COARSE)
    answer = page.tab.locator(".wv-hint")
    page.tab.get_by_role("button", name="2D Goal Pose").wait_for(timeout=60_000)

    def publish(key: str, topic: str) -> bool:
        """Use a tool, again until the two programs know each other."""
        page.tab.keyboard.press(key)
        page.tab.mouse.move(600, 250)
        page.tab.mouse.down()
        page.tab.mouse.move(700, 250, steps=3)
        page.tab.mouse.up()
        page.wait_for(lambda: f"/{topic}" in answer.inner_text(), "the answer")
        return answer.inner_text() == f"Published to /{topic}, 1 subscription."

    for topic, (key, heard) in SENT.items():
        page.wait_for(functools.partial(publish, key, topic), "a subscription", 60)
        echo.wait_for(rf"{topic} {heard}")
    page.tab.get_by_role("tab", name="Joints").click()
    slider = page.tab.get_by_role("slider", name="slide")
    slider.wait_for(timeout=60_000)
    assert slider.input_value() == "0.5"
    page.tab.get_by_role("button", name="Center").click()
    echo.wait_for(r"joint_states JointState\(.*name=\['slide'\], position=\[0\.5\]")
