"""The pictures themselves can fail, and each shows something of its own."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from pathlib import Path

import building
import numpy as np
import pytest
from robots import DEMO, place_links

from webviz import Display
from webviz.api.views import Orbit
from webviz.shell.pictures.browser import Pixels
from webviz.shell.testing import TOLERANCE, Harness, share_of_difference, turned
from webviz.shell.testing.comparing import load
from webviz_displays.axes import Axes
from webviz_displays.grid import Grid
from webviz_displays.laser_scan import LaserScan
from webviz_displays.map import Map
from webviz_displays.odometry import Odometry
from webviz_displays.path import Path as PathDisplay
from webviz_displays.robot_model import RobotModel
from webviz_displays.tf import TF
from webviz_sim.pose import Pose2D

REFERENCES = Path(__file__).parent
FOLDERS = sorted(path for path in REFERENCES.iterdir() if any(path.rglob("*.png")))
EVERYTHING: tuple[type[Display], ...] = (
    Grid,
    Axes,
    TF,
    Map,
    RobotModel,
    LaserScan,
    PathDisplay,
    Odometry,
)


def stems(folder: Path) -> list[str]:
    results = sorted(folder.rglob("*.png"))
    return [str(path.relative_to(REFERENCES).with_suffix("")) for path in results]


def picture(name: str) -> Pixels:
    return load(REFERENCES / f"{name}.png")


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda folder: folder.name)
def test_no_picture_is_taken_for_another_one(folder: Path) -> None:
    pictures = {name: picture(name) for name in stems(folder)}
    assert pictures
    for (one, a), (other, b) in itertools.combinations(pictures.items(), 2):
        assert share_of_difference(a, b) > TOLERANCE, f"{one} and {other} look alike"


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda folder: folder.name)
def test_pictures_are_small(folder: Path) -> None:
    for path in folder.rglob("*.png"):
        assert path.stat().st_size < 20_000, path


def test_a_shade_does_not_count_but_a_shift_does() -> None:
    for name in ("laser_scan/default", "robot_model/default"):
        pixels = picture(name)
        brighter = np.minimum(pixels, 245) + np.uint8(10)
        assert share_of_difference(pixels, brighter) <= TOLERANCE
        assert share_of_difference(pixels, np.roll(pixels, 2, axis=1)) > TOLERANCE


def everything(harness: Harness) -> None:
    """Something to see for every display."""
    place = Pose2D(-2.0, 0.0, 0.5)
    harness.transform("map", "base_link", (place.x, place.y, 0.0), turned(yaw=place.yaw))
    place_links(harness, DEMO, below="base_link")
    harness.publish("/robot_description", "std_msgs/msg/String", {"data": DEMO.read_text()})
    harness.publish("/map", "nav_msgs/msg/OccupancyGrid", building.grid(), frame="map")
    measured = building.scan(place)
    harness.publish("/scan", "sensor_msgs/msg/LaserScan", measured, frame="base_scan")
    line = building.path([(-2.0, 0.0), (-1.0, 0.3), (0.0, 0.3)])
    harness.publish("/path", "nav_msgs/msg/Path", line, frame="map")
    pose = {"position": {"x": -3.0}, "orientation": {"w": 1.0}}
    harness.publish("/odom", "nav_msgs/msg/Odometry", {"pose": {"pose": pose}}, frame="map")
    harness.settle()


def test_without_any_one_of_its_displays_a_scene_has_another_picture(
    webviz_harness: Callable[..., Harness],
) -> None:
    view = Orbit(distance=5.0, yaw=-2.0, pitch=0.7, focal_point=(-2.0, 0.0, 0.0))
    harness = webviz_harness(*(cls() for cls in EVERYTHING), view=view)
    everything(harness)
    harness.check_picture("all_displays/together", each_display=True)
