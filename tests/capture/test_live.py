"""Pictures of a running ROS graph."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import PIL.Image
import pytest

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install webviz[ros]")

from robot import Robot, Scan

CONFIG = Path(__file__).parent / "top.yaml"


@pytest.fixture
def robot(webviz_domain: int) -> Iterator[Robot]:
    robot = Robot(webviz_domain)
    robot.static("map", "odom")
    robot.links["odom", "base"] = 0.0
    yield robot
    robot.close()


def screenshot(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "webviz", "screenshot", "-d", str(CONFIG), "-o", "a.png"]
    return subprocess.run(
        [*command, "--size", "320x240", *arguments],
        capture_output=True,
        text=True,
        timeout=100,
        cwd=folder,
    )


def test_a_running_robot_becomes_a_picture_once_its_display_is_ok(robot, tmp_path):
    robot.scans["/scan"] = Scan("base", offset_s=-0.1)
    result = screenshot(tmp_path, "--timeout", "60")
    assert result.returncode == 0, result.stderr
    with PIL.Image.open(tmp_path / "a.png") as image:
        assert (np.asarray(image) == (255, 0, 255)).all(axis=2).sum() > 20


def test_a_display_that_never_becomes_ok_is_reported_after_the_time_out(robot, tmp_path):
    result = screenshot(tmp_path, "--timeout", "3")
    assert result.returncode == 3, result.stderr
    assert "not all displays are OK within 3 s" in result.stderr
    assert "No publisher on /scan" in result.stderr
