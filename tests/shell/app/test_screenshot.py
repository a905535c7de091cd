"""Pictures of a viewer at work, by a real browser."""

from __future__ import annotations

import asyncio
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import photos
import PIL.Image
import pytest
from refusals import refusal_of

import webviz
import webviz_urdf
from webviz.data.messages import encode
from webviz.scene.schemes import BACKGROUND
from webviz.shell.pictures.browser import VARIABLE
from webviz.shell.testing.messages import header
from webviz.shell.testing.source import HandFedSource

ROBOT = Path(webviz_urdf.__file__).parent / "demo" / "robot.urdf"
SIZE = (320, 240)
BEHIND = (10, 40, 80)


def is_red(pixels: np.ndarray) -> float:
    """The share of a picture that has the colour of the x axis, lit or not."""
    red, green, blue = pixels.astype(int).transpose(2, 0, 1)
    return float(((red > 120) & (green < 60) & (blue < 60)).mean())


def test_a_picture_has_displays_just_added_and_image_panes(
    viewer: webviz.Viewer, source: HandFedSource, tmp_path: Path
) -> None:
    viewer.background = BEHIND
    viewer.view = {"type": "TopDownOrtho", "scale": 100.0}
    viewer.add("Axes", length=1.0, radius=0.2)
    path = tmp_path / "now.png"
    near = viewer.screenshot(path, size=SIZE)
    assert near.shape == (240, 320, 3)
    assert 0.03 < is_red(near) < 0.06
    assert (near == BEHIND).all(axis=2).mean() > 0.8
    assert np.array_equal(np.asarray(PIL.Image.open(path)), near)
    viewer.save_view("Far", {"type": "TopDownOrtho", "scale": 20.0})
    viewer.add("Image", topic="/image")
    green = np.full((12, 16, 3), (0, 255, 0), np.uint8)
    message = photos.raw(green, "rgb8") | {"header": header("camera", source.now)}
    source.put("/image", photos.RAW, encode(photos.RAW, message))

    async def cell() -> np.ndarray:
        """Make a picture as a cell of a notebook does."""
        return viewer.screenshot(size=SIZE, view="Far")

    with ThreadPoolExecutor(1) as notebook:
        far = notebook.submit(lambda: asyncio.run(cell())).result()
    assert 0.0 < is_red(far) < 0.3 * is_red(near)
    assert np.abs(far[120, -48] - np.array((0, 255, 0))).max() < 4  # amid the right 30 %
    assert np.array_equal(far[20, 100], BEHIND)


def test_a_robot_is_loaded_before_its_picture_is_made(viewer: webviz.Viewer) -> None:
    viewer.fixed_frame = "base_link"
    viewer.view = {"distance": 1.5}
    packages = [str(ROBOT.parents[2])]
    robot = viewer.add(
        "RobotModel",
        description_source="File",
        description_file=str(ROBOT),
        package_paths=packages,
    )
    pixels = viewer.screenshot(size=SIZE)
    assert (pixels != np.array(BACKGROUND)).any(axis=2).mean() > 0.03
    assert "visuals loaded" in robot.statuses["URDF"].text


def test_invalid_screenshots_are_refused(
    viewer: webviz.Viewer, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert "no supported image extension" in refusal_of(lambda: viewer.screenshot("now.txt"))
    assert "pixels per side" in refusal_of(lambda: viewer.screenshot(size=(1, 1)))
    assert "Unknown saved view `Top`" in refusal_of(lambda: viewer.screenshot(view="Top"))
    monkeypatch.setenv(VARIABLE, "/no/browser")
    assert "/no/browser" in refusal_of(viewer.screenshot)
