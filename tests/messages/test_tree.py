"""Messages as trees that are short enough to be sent."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

from webviz.data.messages import (
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
from webviz.data.messages.definitions import DEFINITIONS


def fields(message: Any, **limits: Any) -> dict[str, Any]:
    tree = to_tree(message, **limits)
    assert isinstance(tree, dict)
    return tree["fields"]


def test_a_message_has_its_fields_in_the_order_of_its_definition() -> None:
    found = fields(JointState(Header(Time(5, 7), "base"), ["left"], np.array([0.5, -1])))
    assert list(found) == ["header", "name", "position", "velocity", "effort"]
    assert found["header"]["fields"]["stamp"] == {"fields": {"sec": "5", "nanosec": "7"}}
    assert found["header"]["fields"]["frame_id"] == "'base'"
    assert found["name"] == {"length": 1, "type": "", "items": ["'left'"]}
    assert found["position"] == {"length": 2, "type": "float64", "items": ["0.5", "-1"]}
    assert found["effort"]["length"] == 0


def test_long_arrays_have_their_length_and_their_first_numbers() -> None:
    ranges = fields(LaserScan(ranges=np.arange(720, dtype=np.float32)))["ranges"]
    assert (ranges["length"], ranges["type"]) == (720, "float32")
    assert ranges["items"] == [str(i) for i in range(20)]


def test_long_strings_are_cut_and_stay_on_one_line() -> None:
    text = fields(String("<robot>\n" * 1000))["data"]
    assert text.endswith("… (8000 characters)")
    assert "\n" not in text


def test_of_many_messages_the_first_ten_are_kept() -> None:
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
def test_a_tree_has_no_more_nodes_than_asked(most: int) -> None:
    poses = PoseStampedSequence(
        np.ones((500, 3)), np.ones((500, 4)), np.ones(500, np.int64), ["map"] * 500
    )
    text = json.dumps(to_tree(Path(poses=poses), most))
    assert text.count('": ') <= 8 * most + 8
    assert "more than is shown here" in text or most == 100


@pytest.mark.parametrize("name", ["visualization_msgs/msg/MarkerArray", *DEFINITIONS])
def test_any_message_can_be_shown(name: str) -> None:
    assert json.dumps(to_tree(message_class(name)()))


def test_numbers_keep_millimetres_at_utm_coordinates() -> None:
    assert fields(JointState(position=np.array([4649776.12])))["position"]["items"] == [
        "4649776.12"
    ]
