"""Pictures of a running ROS graph."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import PIL.Image
import pytest

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install webviz[ros]")

from robot import Robot, Scan

SMALL = ["--size", "320x240"]


@pytest.fixture
def robot(webviz_domain: int) -> Iterator[Robot]:
    robot = Robot(webviz_domain)
    robot.static("map", "odom")
    robot.links["odom", "base"] = 0.0
    yield robot
    robot.close()


def test_a_running_robot_becomes_a_picture_once_its_display_is_ok(robot, tmp_path, screenshot):
    robot.scans["/scan"] = Scan("base", offset_s=-0.1)
    result = screenshot("-o", "a.png", *SMALL, "--timeout", "60")
    assert result.status == 0, result.errors
    with PIL.Image.open(tmp_path / "a.png") as image:
        assert (np.asarray(image) == (255, 0, 255)).all(axis=2).sum() > 20


@pytest.mark.usefixtures("robot")
def test_a_display_that_never_becomes_ok_is_reported_after_the_time_out(screenshot):
    result = screenshot("-o", "a.png", *SMALL, "--timeout", "0.5")
    assert result.status == 3, result.errors
    assert "not all displays are OK within 0.5 s" in result.errors
    assert "No publisher on /scan" in result.errors
