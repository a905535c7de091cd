"""Another DDS stack drives the viewer: Eclipse Cyclone DDS, without ROS."""

from __future__ import annotations

import functools
import os
import re
import signal
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from displays_panel import DisplaysPanel
from pages import let_mouse_in
from peer_python import peer_python
from program import Program

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
"""Keys of a tool, and what the peer hears of it, by topic."""


@pytest.fixture(scope="module")
def peer(
    webviz_domain: int, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Callable[..., Program]]:
    """Run programs of the peer on the domain of the viewer."""
    if not PEER.exists():
        pytest.skip("the independent peer is not here: ../shared/tools/cyclone_peer.py")
    python = str(peer_python())
    programs: list[Program] = []
    # The wheels of rclpy mark the environment of child processes, which are not theirs here.
    env = {k: v for k, v in os.environ.items() if k != "_ROS_WHEELS_BOOTSTRAP_COMPLETE"}

    def run(*arguments: str) -> Program:
        command = [
            python,
            "-u",
            *arguments,
            "--seconds",
            "120",
            "--domain",
            str(webviz_domain),
        ]
        log = tmp_path_factory.mktemp("peer") / "output.txt"
        programs.append(Program(command, env, log))
        return programs[-1]

    yield run
    for program in programs:
        program.end(signal.SIGTERM)


@pytest.fixture(scope="module")
def viewer(webviz_domain: int, tmp_path_factory: pytest.TempPathFactory) -> Iterator[webviz.Viewer]:
    config = tmp_path_factory.mktemp("config") / "peer.yaml"
    config.write_text(CONFIG)
    with pytest.MonkeyPatch.context() as patch:
        # With it, rclpy announces itself to other processes in a way that only Fast DDS looks for.
        patch.delenv("ROS_AUTOMATIC_DISCOVERY_RANGE", raising=False)
        with webviz.Viewer(config, port=0) as viewer:
            yield viewer


def count(page: Page, rgb: tuple[int, int, int]) -> int:
    """Pixels of about one colour."""
    page.draw()
    return int((np.abs(page.pixels().astype(int) - rgb).max(axis=2) < 40).sum())


SILENT = """
import sys, time
sys.path.insert(0, sys.argv[1])
from cyclone_peer import SENSOR, DataWriter, DomainParticipant, LaserScan, Topic
participant = DomainParticipant(int(sys.argv[-1]))
writer = DataWriter(participant, Topic(participant, "rt/scan", LaserScan), qos=SENSOR)
time.sleep(120)
"""


def test_a_program_without_a_node_that_sends_nothing(
    peer: Callable[..., Program], viewer: webviz.Viewer
) -> None:
    def wait_until(is_found: bool) -> None:
        until = time.monotonic() + PATIENCE_S
        while ("GRAPH013" in {each.id for each in viewer.doctor()}) != is_found:
            assert time.monotonic() < until, [each.cause for each in viewer.doctor()]

    program = peer("-c", SILENT, str(PEER.parent))
    wait_until(True)
    program.end(signal.SIGTERM)
    wait_until(False)


def test_messages_reach_an_independent_peer_and_come_back(
    peer: Callable[..., Program],
    viewer: webviz.Viewer,
    open_page: Callable[..., Page],
    tmp_path: Path,
) -> None:
    page = open_page(viewer.url)
    page.hold()
    let_mouse_in(page)
    check_tools_and_sliders(page, peer, tmp_path)
    page.tab.get_by_role("tab", name="Displays").click()
    peer(str(PEER), "pub", "all")
    page.wait_for(lambda: count(page, (255, 0, 255)) > 300, "the scan", 60)
    page.wait_for(lambda: count(page, (255, 255, 0)) > 100, "the path")
    page.wait_for(lambda: count(page, (255, 255, 255)) > 10_000, "the map")
    page.wait_for(lambda: page.tab.locator(".wv-tree [data-level=error]").count() == 0, "no error")
    side = DisplaysPanel(page)
    side.select("LaserScan")
    side.wait_for("from a DDS program (best effort, volatile)")


def check_tools_and_sliders(page: Page, peer: Callable[..., Program], folder: Path) -> None:
    """The peer receives what they send from the page; it publishes the robot of the sliders."""
    (urdf := folder / "robot.urdf").write_text(ROBOT)
    describing = peer(str(PEER), "pub", "robot_description", "--urdf", str(urdf))
    echo = peer(str(PEER), "echo", *SENT, "joint_states")
    answer = page.tab.locator(".wv-hint")
    page.tab.get_by_role("button", name="2D Goal Pose").wait_for(timeout=60_000)

    def is_heard(key: str, topic: str, message: str) -> bool:
        """Use a tool, again until the two programs know each other."""
        page.tab.keyboard.press(key)
        page.tab.mouse.move(600, 250)
        page.tab.mouse.down()
        page.tab.mouse.move(700, 250, steps=3)
        page.tab.mouse.up()
        page.wait_for(lambda: f"/{topic}" in answer.inner_text(), "the answer")
        is_known = answer.inner_text() == f"Published to /{topic}, 1 subscription."
        return is_known and bool(re.search(rf"{topic} {message}", echo.output()))

    for topic, (key, message) in SENT.items():
        page.wait_for(functools.partial(is_heard, key, topic, message), message, 60)
    page.tab.get_by_role("tab", name="Joints").click()
    slider = page.tab.get_by_role("slider", name="slide")
    slider.wait_for(timeout=60_000)
    assert slider.input_value() == "0.5"
    page.tab.get_by_role("button", name="Center").click()
    echo.wait_for(r"joint_states JointState\(.*name=\['slide'\], position=\[0\.5\]")
    for each in (echo, describing):
        each.end(signal.SIGTERM)
