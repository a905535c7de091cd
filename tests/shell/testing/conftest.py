"""Scenes for tests of what other packages are given."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from webviz import Topic
from webviz.shell.testing import Harness
from webviz_displays.grid import Grid
from webviz_displays.laser_scan import LaserScan
from webviz_displays.tf import TF

SCAN = {
    "angle_min": -1.5,
    "angle_increment": 0.5,
    "range_max": 10.0,
    "ranges": [2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0],
}


@pytest.fixture
def stage(webviz_harness: Callable[..., Harness]) -> Harness:
    """Grid, a scan and the frames, with nothing published yet."""
    return webviz_harness(Grid(), LaserScan(name="Scan", topic=Topic("/scan"), size=0.2), TF())


@pytest.fixture
def filled(stage: Harness) -> Harness:
    """The same with a scan of seven points, 2 m around a laser at (1, 0, 0.5)."""
    stage.transform("map", "laser", (1.0, 0.0, 0.5))
    stage.publish("/scan", "sensor_msgs/msg/LaserScan", SCAN, frame="laser")
    stage.wait_until_drawn("Scan")
    return stage
