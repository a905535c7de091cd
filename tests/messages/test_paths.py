"""Values in messages by their paths."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from webviz.data.messages import (
    FrameTransform,
    Header,
    JointState,
    LaserScan,
    Odometry,
    Path,
    PoseStampedSequence,
    String,
    TFMessage,
    Time,
    message_class,
)
from webviz.data.messages.definitions import DEFINITIONS
from webviz.data.messages.paths import FieldPath, PathError, numeric_paths

JOINTS = JointState(Header(Time(5, 500_000_000)), ["left", "right"], np.array([0.5, math.nan]))
STATUS = message_class("diagnostic_msgs/msg/DiagnosticStatus")
DIAGNOSTICS = message_class("diagnostic_msgs/msg/DiagnosticArray")(
    status=[STATUS(name="motor: left", level=2), STATUS(name="battery")]
)
POLYGON = message_class("geometry_msgs/msg/Polygon")(points=np.array([[1, 2, 3]]))
POSES = PoseStampedSequence(np.ones((2, 3)), np.ones((2, 4)), np.array([10**9, 0]), ["map"] * 2)


@pytest.mark.parametrize(
    ("message", "path", "number"),
    [
        (JOINTS, "position[0]", 0.5),
        (JOINTS, "position[-2]", 0.5),
        (JOINTS, "position[left]", 0.5),
        (JOINTS, "position[right]", math.nan),
        (JOINTS, "header.stamp", 5.5),
        (JOINTS, "header.stamp.nanosec", 5e8),
        (DIAGNOSTICS, "status[motor: left].level", 2.0),
        (Path(poses=POSES), "poses[1].pose.position.z", 1.0),
        (Odometry(), "pose.covariance[35]", 0.0),
        (JointState(position=np.array([1e308])), "position[0]", 1e308),
        (POLYGON, "points[0].y", 2),
    ],
)
def test_a_number_is_found_by_its_path(message: Any, path: str, number: float) -> None:
    assert FieldPath(path).number(message) == pytest.approx(number, nan_ok=True)


@pytest.mark.parametrize(
    ("message", "path", "reason"),
    [
        (JOINTS, "velocity[0]", "No element 0 for `velocity[0]`; there are 0."),
        (JOINTS, "position[2]", "No element 2 for `position[2]`; there are 2."),
        (JOINTS, "position[-3]", "No element -3 for `position[-3]`; there are 2."),
        (JOINTS, "position[tail]", "No element named tail for `position[tail]`; there are 2."),
        (JOINTS, "speed", "No field `speed` for `speed`. Choose one of header, name, position"),
        (JOINTS, "position", "`position` is not a number. Choose one of its parts."),
        (JOINTS, "position[0].x", "No field `x` for `position[0].x`. Choose a path without it."),
        (POLYGON, "points.x", "No field `x` for `points.x`. Choose a path without it."),
        (JOINTS, "header[0]", "`header[0]` asks for an element of what is not an array."),
        (String("text"), "data[0]", "`data[0]` asks for an element of what is not an array."),
        (String("text"), "data", "`data` is not a number. Choose one of its parts."),
    ],
)
def test_what_is_not_there_is_named_with_a_remedy(message: Any, path: str, reason: str) -> None:
    with pytest.raises(PathError) as error:
        FieldPath(path).number(message)
    assert str(error.value).startswith(reason)


@pytest.mark.parametrize(
    "text", ["", ".", "a.", "a..b", "[0]", "a[", "a[0", "a b", "é", "__x__.", "a[[0]]", "a" * 500]
)
def test_what_is_not_a_path_is_refused(text: str) -> None:
    with pytest.raises(PathError, match="is not the path of a field"):
        FieldPath(text)


def test_the_numbers_of_a_message_are_listed_by_name_if_they_have_one() -> None:
    assert numeric_paths(JOINTS, 99) == [
        "header.stamp",
        "position[left]",
        "position[right]",
    ]
    assert len(numeric_paths(LaserScan(ranges=np.zeros(1000, np.float32)), 25)) == 25


def test_elements_are_called_by_names_that_are_unique_and_no_numbers() -> None:
    for names, called in (
        (["a", "b"], ["a", "b"]),
        (["a", "a"], [0, 1]),
        (["a", "1"], [0, 1]),
        (["a", "b]"], [0, 1]),
        (["a", ""], [0, 1]),
        (["a"], [0, 1]),
    ):
        joints = JointState(name=names, effort=np.zeros(2))
        assert numeric_paths(joints, 9)[1:] == [f"effort[{key}]" for key in called]


def test_the_most_telling_name_of_an_element_counts() -> None:
    frames = TFMessage([FrameTransform("map", "odom", 5, (1.0, 2.0, 3.0), (0.0, 0.0, 0.0, 1.0))])
    assert FieldPath("transforms[odom].translation[1]").number(frames) == 2.0
    with pytest.raises(PathError, match="No element named map"):
        FieldPath("transforms[map].stamp_ns")(frames)


@pytest.mark.parametrize("name", DEFINITIONS)
def test_every_path_that_is_listed_is_a_number(name: str) -> None:
    message = message_class(name)()
    for path in numeric_paths(message, 100):
        assert math.isfinite(FieldPath(path).number(message))
