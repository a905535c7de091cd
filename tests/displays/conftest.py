"""Displays at work under short names."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Any

import pytest
from inspecting import QUARTER, Benches
from robot_arm import ARM, describe, place_arm

from webviz.api.display import Display, inputs
from webviz.shell.testing import DisplayBench
from webviz_displays.robot_model import RobotModel

STRAIGHT = (0.0, 0.0, 0.0, 1.0)


@pytest.fixture
def bench(webviz_bench: Benches) -> Benches:
    """Make a `DisplayBench` of a display."""
    return webviz_bench


@pytest.fixture
def arm(bench: Benches) -> DisplayBench:
    """The bench of a RobotModel that shows an arm."""
    at = bench(RobotModel())
    place_arm(at)
    describe(at, ARM)
    return at


@pytest.fixture
def display_bench(bench: Benches) -> Benches:
    """Make the bench of a display that has drawn messages in the frame odom, 10 m along x."""
    return partial(_display_bench, bench, STRAIGHT)


@pytest.fixture
def turned(bench: Benches) -> Benches:
    """Make the bench as `display_bench`, with odom turned left by a quarter."""
    return partial(_display_bench, bench, QUARTER)


def _display_bench(
    bench: Benches,
    rotation: tuple[float, float, float, float],
    display: Display,
    *messages: Mapping[str, Any],
) -> DisplayBench:
    at = bench(display)
    at.transform("map", "odom", (10.0, 0.0, 0.0), rotation)
    for values in messages:
        at.send(inputs(display)[0][1].type, values, frame="odom")
        at.turn()
        at.settle()
    return at


@pytest.fixture
def sensed(bench: Benches) -> Benches:
    """Make the bench of a display that has drawn a message of a sensor at rest, 1 m above map."""

    def make(display: Display, values: Mapping[str, Any]) -> DisplayBench:
        at = bench(display)
        at.transform("map", "sensor", (0.0, 0.0, 1.0))
        at.send(inputs(display)[0][1].type, values, frame="sensor")
        at.turn()
        return at

    return make
