"""Messages as trees that are short enough to be sent."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from known_types import OURS

from webviz.data.messages import (
    Duration,
    FrameTransform,
    Header,
    JointState,
    LaserScan,
    Path,
    PoseStampedSequence,
    String,
    TFMessage,
    Time,
    message_class,
    to_tree,
)


def fields(message: Any, **limits: Any) -> dict[str, Any]:
    tree = to_tree(message, **limits)
    assert isinstance(tree, dict)
    return tree["fields"]


def test_a_message_has_its_fields_in_the_order_of_its_definition() -> None:
    tree = fields(JointState(Header(Time(5, 7), "base"), ["left"], np.array([0.5, -1])))
    assert list(tree) == ["header", "name", "position", "velocity", "effort"]
    assert tree["header"]["fields"]["stamp"] == {"fields": {"sec": "5", "nanosec": "7"}}
    assert tree["header"]["fields"]["frame_id"] == "'base'"
    assert tree["name"] == {"length": 1, "type": "", "items": ["'left'"]}
    assert tree["position"] == {"length": 2, "type": "float64", "items": ["0.5", "-1"]}
    assert tree["effort"]["length"] == 0


def test_long_arrays_have_their_length_and_their_first_numbers() -> None:
    ranges = fields(LaserScan(ranges=np.arange(720, dtype=np.float32)))["ranges"]
    assert (ranges["length"], ranges["type"]) == (720, "float32")
    assert ranges["items"] == [str(i) for i in range(20)]


def test_long_strings_are_cut_and_stay_on_one_line() -> None:
    text = fields(String("<robot>\n" * 1000))["data"]
    assert text.endswith("… (8000 characters)")
    assert "\n" not in text


def test_the_first_ten_elements_of_a_list_are_kept() -> None:
    transform = FrameTransform("map", "odom", 12, (1.0, 2.0, 3.0), (0.0, 0.0, 0.0, 1.0))
    (transforms,) = fields(TFMessage([transform] * 25)).values()
    assert (transforms["length"], len(transforms["items"])) == (25, 10)
    assert transforms["items"][0]["fields"]["parent"] == "'map'"


def test_poses_of_a_path_are_as_in_ros() -> None:
    poses = PoseStampedSequence(np.ones((1, 3)), np.ones((1, 4)), np.array([10**9]), ["map"])
    (pose,) = fields(Path(poses=poses))["poses"]["items"]
    assert pose["fields"]["header"]["fields"]["stamp"]["fields"]["sec"] == "1"
    assert pose["fields"]["pose"]["fields"]["position"]["fields"]["x"] == "1"


@pytest.mark.parametrize("most", [1, 5, 100])
def test_the_number_of_nodes_of_a_tree_is_limited(most: int) -> None:
    poses = PoseStampedSequence(
        np.ones((500, 3)), np.ones((500, 4)), np.ones(500, np.int64), ["map"] * 500
    )
    text = json.dumps(to_tree(Path(poses=poses), most))
    assert text.count('": ') <= 8 * most + 8
    assert "more than is shown here" in text or most == 100


@pytest.mark.parametrize("name", ["visualization_msgs/msg/MarkerArray", *OURS])
def test_any_message_can_be_shown(name: str) -> None:
    assert json.dumps(to_tree(message_class(name)()))


def test_numbers_keep_millimetres_at_utm_coordinates() -> None:
    assert fields(JointState(position=np.array([4649776.12])))["position"]["items"] == [
        "4649776.12"
    ]


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (Time(1_700_000_000, 12_999_999), "2023-11-14 22:13:20.012 UTC"),
        (Time(31_536_000), "1971-01-01 00:00:00.000 UTC"),
        (Time(31_535_999, 500_000_000), "31535999.500 s"),
        (Duration(-2, 500_000_000), "-1.5 s"),
    ],
)
def test_times_for_people_are_dates_and_seconds(value: Time | Duration, text: str) -> None:
    assert to_tree(value, is_readable=True) == text


def test_rows_of_numbers_say_how_long_they_are() -> None:
    points = message_class("geometry_msgs/msg/Polygon")(points=np.zeros((30, 3), np.float32))
    result = fields(points, max_items=4)["points"]
    assert (result["length"], result["type"]) == (30, "3 x float32")
    assert result["items"] == ["0"] * 4


def test_digits_and_elements_are_limited() -> None:
    tree = fields(JointState(name=["a"] * 9, position=np.array([1 / 3] * 9)), digits=2, max_items=3)
    assert tree["name"]["items"] == ["'a'"] * 3
    assert tree["position"]["items"] == ["0.33"] * 3


def test_a_string_is_whole_up_to_its_limit() -> None:
    assert fields(String("x" * 400))["data"] == repr("x" * 400)
    assert fields(String("x" * 401))["data"] == repr("x" * 400) + " … (401 characters)"
