"""Pictures of a running ROS graph."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import photos
import PIL.Image
import pytest

from tests.shell.pictures.conftest import CommandResult

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install ros-webviz[ros]")

from robot import Robot, Scan

SMALL = ["--size", "320x240"]


@pytest.fixture
def robot(webviz_domain: int) -> Iterator[Robot]:
    robot = Robot(webviz_domain)
    robot.static("map", "odom")
    robot.links["odom", "base"] = 0.0
    yield robot
    robot.close()


def test_a_running_robot_becomes_a_picture_once_its_display_is_ok(
    robot: Robot, tmp_path: Path, screenshot: Callable[..., CommandResult]
) -> None:
    robot.scans["/scan"] = Scan("base", offset_s=-0.1)
    result = screenshot("-o", "a.png", *SMALL, "--timeout", "60")
    assert result.status == 0, result.errors
    with PIL.Image.open(tmp_path / "a.png") as image:
        assert (np.asarray(image) == (255, 0, 255)).all(axis=2).sum() > 20


@pytest.mark.usefixtures("robot")
def test_a_display_that_never_becomes_ok_is_reported_after_the_time_out(
    screenshot: Callable[..., CommandResult],
) -> None:
    result = screenshot("-o", "a.png", *SMALL, "--timeout", "0.5")
    assert result.status == 3, result.errors
    assert "not all displays are OK within 0.5 s" in result.errors
    assert "No publisher on /scan" in result.errors


@pytest.mark.parametrize(("name", "is_depth"), [("raw", False), ("raw/compressedDepth", True)])
def test_an_image_of_a_running_camera_is_written_as_it_is(
    robot: Robot,
    tmp_path: Path,
    screenshot: Callable[..., CommandResult],
    name: str,
    is_depth: bool,
) -> None:
    colors, depths = photos.room(32, 24)
    millimetres = np.nan_to_num(1000 * depths).astype(np.uint16)
    images = {
        "raw": (photos.RAW, photos.raw(colors, "rgb8")),
        "raw/compressedDepth": (photos.COMPRESSED, photos.compressed_depth(millimetres)),
    }
    type_name, values = images[name]
    robot.publish(f"/camera/{name}", type_name, values, latched=True)
    result = screenshot("-o", "a.png", "--image", f"/camera/{name}", "--timeout", "60", config=None)
    assert result.status == 0, result.errors
    with PIL.Image.open(tmp_path / "a.png") as image:
        pixels = np.asarray(image, np.float64)
    assert pixels.shape == (24, 32, 3)
    expected = colors.astype(np.float64)
    if is_depth:
        low, high = millimetres[millimetres > 0].min(), millimetres.max()
        grey = np.clip(255 * (millimetres.astype(np.float64) - low) / (high - low), 0, 255)
        expected = np.repeat(grey[..., None], 3, axis=2)
    assert np.abs(pixels - expected).mean() < 2


@pytest.mark.usefixtures("robot")
def test_a_missing_image_is_explained_in_one_sentence(
    screenshot: Callable[..., CommandResult],
) -> None:
    # Longer than a page may hide a pane before its display is not received any more.
    result = screenshot("-o", "a.png", "--image", "/nothing", "--timeout", "2.5", config=None)
    assert result.status != 0
    assert result.errors.startswith("webviz: No image to write. No publisher on /nothing.")
    assert result.errors.count("\n") == 1
