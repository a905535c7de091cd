"""Values in messages by their paths."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from known_types import OURS

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
from webviz.data.messages.message_paths import MAX_KEPT, MessagePath
from webviz.data.messages.paths import (
    MAX_FOUND,
    MAX_LENGTH,
    FieldPath,
    NothingMatches,
    PathError,
    numeric_paths,
)

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
        (JOINTS, "header[0]", "`header[0]` indexes a value that is not an array."),
        (String("text"), "data[0]", "`data[0]` indexes a value that is not an array."),
        (String("text"), "data", "`data` is not a number. Choose one of its parts."),
    ],
)
def test_a_missing_field_is_reported_with_a_remedy(message: Any, path: str, reason: str) -> None:
    with pytest.raises(PathError) as error:
        FieldPath(path).number(message)
    assert str(error.value).startswith(reason)


@pytest.mark.parametrize(
    "text", ["", ".", "a.", "a..b", "[0]", "a[", "a[0", "a b", "é", "__x__.", "a[[0]]", "a" * 500]
)
def test_invalid_paths_are_refused(text: str) -> None:
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


@pytest.mark.parametrize(
    ("message", "path", "values"),
    [
        (DIAGNOSTICS, "status[:].name", ["motor: left", "battery"]),
        (DIAGNOSTICS, "status[:]{level>=2}.name", ["motor: left"]),
        (DIAGNOSTICS, "status{level==0}.name", ["battery"]),
        (DIAGNOSTICS, "status{name=='motor: left'}.level", [2]),
        (DIAGNOSTICS, 'status{ name != "battery" }{level<1}.name', []),
        (DIAGNOSTICS, "status{voltage>1}.name", []),
        (DIAGNOSTICS, "status{name>1}.name", []),
        (DIAGNOSTICS, "{header.stamp<1}.status[-1].name", ["battery"]),
        (JOINTS, "name[0:0]", ["left"]),
        (JOINTS, "name[-1:]", ["right"]),
        (JOINTS, "name[5:9]", []),
        (JOINTS, "name[-9:9]", ["left", "right"]),
        (POLYGON, "points[:].y", [2]),
        (POLYGON, "points{x==1}.z", [3]),
        (POSES, "[:]", None),
        (Path(poses=POSES), "poses{pose.position.x>=1}.header.stamp", [Time(1, 0), Time(0, 0)]),
    ],
)
def test_slices_and_filters_find_several_values(message: Any, path: str, values: Any) -> None:
    if values is None:
        with pytest.raises(PathError):
            FieldPath(path)
    else:
        assert FieldPath(path)(message) == values


def test_a_number_needs_exactly_one_match() -> None:
    with pytest.raises(NothingMatches, match="Nothing in the newest message matches"):
        FieldPath("status{level>5}.level").number(DIAGNOSTICS)
    with pytest.raises(PathError, match="2 values match"):
        FieldPath("status[:].level").number(DIAGNOSTICS)
    assert FieldPath("status{level>1}.level").number(DIAGNOSTICS) == 2.0


@pytest.mark.parametrize(
    "text",
    [
        "status{",
        "status{}",
        "status{level}",
        "status{level=1}",
        "status{level==}",
        "status{level==nan}",
        "status{level==1e999}",
        "status{level==x}",
        "status{level=='a}",
        "status{{level==1}}",
        "{level==1}",
        "a{b==1}c",
        "a[:",
        "a{" + "b." * 300 + "c==1}",
    ],
)
def test_slices_and_filters_that_cannot_be_read_are_refused(text: str) -> None:
    with pytest.raises(PathError, match="is not the path of a field"):
        FieldPath(text)


def test_a_large_array_is_neither_copied_nor_searched_without_end() -> None:
    scan = LaserScan(ranges=np.ones(3_000_000, np.float32))
    assert len(FieldPath("ranges[:]")(scan)) == MAX_FOUND
    assert FieldPath("ranges[-999999999:999999999]")(scan)[0] == 1.0


@pytest.mark.parametrize(
    ("path", "number"),
    [
        ("/odom.pose.pose.position.@norm", 13.0),
        ("/odom.pose.pose.orientation.@yaw.@degrees", 90.0),
        ("/odom.pose.pose.orientation.@yaw.@negative.@abs.@degrees", 90.0),
        ("/odom.pose.pose.orientation.@roll", 0.0),
        ("/odom.pose.pose.orientation.@pitch", 0.0),
        ("/odom.pose.pose.position.y", 4.0),
    ],
)
def test_a_message_path_has_functions(path: str, number: float) -> None:
    odometry = Odometry()
    pose = odometry.pose.pose
    turned = type(pose.orientation)(z=math.sqrt(0.5), w=math.sqrt(0.5))
    placed = type(pose)(type(pose.position)(3.0, 4.0, 12.0), turned)
    odometry = Odometry(pose=type(odometry.pose)(pose=placed))
    assert MessagePath(path).topic == "/odom"
    assert MessagePath(path).number(odometry) == pytest.approx(number)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "has no topic"),
        ("/", "has no topic"),
        ("odom.x", "has no topic"),
        ("/odom x", "is not the path of a field"),
        ("/odom.x.@root", "Unknown function `@root`. Use @norm"),
        ("/odom.x.@abs(2)", "`@abs` takes no argument."),
        ("/odom.x.@mean(0)", "needs seconds"),
        ("/odom.x.@mean(1.2.3)", "needs seconds"),
        ("/odom.x.@derivative.@abs", "comes before functions over time"),
        ("/odom.x.@abs.@norm", "Make it the first function."),
        ("/odom.x" + ".@abs" * 9, "more than 8 functions"),
        ("/odom." + "x" * MAX_LENGTH, "has no topic"),
        ("/odom.@abs(<b>)", "is not the path of a field"),
    ],
)
def test_an_unreadable_message_path_has_a_reason(text: str, reason: str) -> None:
    with pytest.raises(PathError) as error:
        MessagePath(text)
    assert reason in str(error.value)


def test_functions_over_time_follow_the_values() -> None:
    mean = MessagePath("/x.y.@mean(2)").over_time()
    assert mean is not None
    assert [mean(t, v) for t, v in ((0, 1.0), (1, 3.0), (2, 5.0), (3, 10.0))] == [1, 2, 3, 6]
    assert mean(4, math.nan) == 7.5
    assert math.isnan(mean(99, math.inf))
    assert [mean(100 + i, 1.7e308) for i in range(3)] == pytest.approx([1.7e308] * 3)
    assert mean(200, 0.25) == 0.25
    for i in range(3 * MAX_KEPT):
        assert mean(300 + i * 1e-5, 0.1) == pytest.approx(0.1)
    change = MessagePath("/x.y.@derivative").over_time()
    assert change is not None
    assert math.isnan(change(0, 1.0))
    assert change(0.5, 2.0) == 2.0
    assert math.isnan(change(0.5, 3.0))


@pytest.mark.parametrize("name", OURS)
def test_every_path_that_is_listed_is_a_number(name: str) -> None:
    message = message_class(name)()
    for path in numeric_paths(message, 100):
        assert math.isfinite(FieldPath(path).number(message))
