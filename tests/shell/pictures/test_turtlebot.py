"""A real robot: the picture of the README."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import PIL.Image
from turtlebot import BAG, DATA, needs_bag

import webviz
from webviz.shell.pictures.headless_renderer import HeadlessRenderer
from webviz.shell.testing.comparing import share_of_difference
from webviz.sources.bag.extras import map_of_file, static_transform

ROOT = Path(__file__).parents[3]
DIFFERENT = 0.01
"""Share of pixels that may differ: the picture was made by one version of one browser."""


@needs_bag
def test_a_turtlebot_its_map_and_its_config_are_one_picture(renderer: HeadlessRenderer) -> None:
    shot = webviz.capture(
        DATA / "rviz/turtlebot_bag_files.rviz",
        bag=BAG,
        at=24.0,
        size=(800, 450),
        focus="base_link",
        wait_for=["Grid", "LaserScan", "Map", "Odometry", "Odometry (2)"],
        extras=[
            map_of_file(DATA / "maps/mac_1st_floor_final.yaml"),
            static_transform("map", "odom", -0.32, 0.04, 0.077),
        ],
        renderer=renderer,
    )
    assert shot.is_ok, shot.statuses
    with PIL.Image.open(ROOT / "tests/pictures/turtlebot.png") as image:
        expected = np.asarray(image.convert("RGB"))
    assert share_of_difference(shot.pixels, expected) < DIFFERENT


@needs_bag
def test_without_the_transform_that_the_bag_lacks_the_fixed_frame_is_missed(
    renderer: HeadlessRenderer,
) -> None:
    shot = webviz.capture(DATA / "rviz/turtlebot_bag_files.rviz", bag=BAG, renderer=renderer)
    assert not shot.is_ok
    assert (
        'Fixed frame "map" does not exist' in shot.pictures[0].readiness.general["Fixed Frame"].text
    )
