"""Encoded messages equal what independent implementations make of the same values."""

from __future__ import annotations

import re
from itertools import product
from random import Random
from typing import Any

import numpy as np
import pytest
from known_types import ROS_TYPES, TYPES, ros_classes
from rosbags_messages import plain, random_message, rosbags_store

from webviz.data.messages import (
    EncodeError,
    PoseSequence,
    PoseStampedSequence,
    decode,
    encode,
    message_class,
    register,
)

SCAN = "sensor_msgs/msg/LaserScan"


def mapping(message: Any, store: Any) -> Any:
    """A message of rosbags' as nested mappings."""
    if type_name := getattr(message, "__msgtype__", None):
        names = [name for name, _ in store.fielddefs[type_name][1]]
        values = (getattr(message, name, None) for name in names)
        return {name: mapping(value, store) for name, value in zip(names, values, strict=True)}
    return [mapping(each, store) for each in message] if isinstance(message, list) else message


@pytest.mark.parametrize("package", TYPES)
def test_every_known_type_is_encoded_as_rosbags_encodes_it_and_decodes_to_itself(
    package: str,
) -> None:
    for type_name, seed in product(TYPES[package], range(10)):
        message = random_message(type_name, Random(seed))
        expected = bytes(rosbags_store().serialize_cdr(message, type_name))
        assert encode(type_name, mapping(message, rosbags_store())) == expected, type_name
        assert encode(type_name, message) == expected, type_name
        again = encode(type_name, decode(type_name, expected))
        assert len(again) == len(expected), type_name
        assert plain(decode(type_name, again)) == plain(message), type_name


@pytest.mark.filterwarnings("ignore:module 'sre_:DeprecationWarning")  # ROS's own imports
@pytest.mark.parametrize("package", ROS_TYPES)
def test_every_known_type_is_encoded_as_ros_itself_encodes_it(package: str) -> None:
    ros = pytest.importorskip("rclpy.serialization")
    for type_name, ros_class in ros_classes(package).items():
        for seed in range(5):
            message = random_message(type_name, Random(seed))
            cdr = bytes(rosbags_store().serialize_cdr(message, type_name))
            theirs = ros.serialize_message(ros.deserialize_message(cdr, ros_class))
            ours = encode(type_name, mapping(message, rosbags_store()))
            assert_same_but_padding(ours, theirs)
            mine, other = (ros.deserialize_message(each, ros_class) for each in (ours, theirs))
            assert mine == other
        assert_same_but_padding(encode(type_name), ros.serialize_message(ros_class()))


def assert_same_but_padding(ours: bytes, theirs: bytes) -> None:
    """Equal in every byte that CDR lays down.

    ROS leaves whatever was in memory between values, where we have zeros, and behind the end, for
    it reserves what a message takes at most. So bytes that differ have to be zero in ours; that
    both mean the same shows when ROS decodes them.
    """
    assert len(theirs) >= len(ours)
    differing = [mine for mine, other in zip(ours, theirs, strict=False) if mine != other]
    assert not any(differing)


@pytest.mark.parametrize(
    ("type_name", "values", "words"),
    [
        (SCAN, {"range_mni": 1.0}, "LaserScan has no field 'range_mni'; did you mean range_min?"),
        (SCAN, {"header": {"stamp": {"sec": 2**31}}}, ".header.stamp.sec: expected int32 (-21474"),
        (SCAN, {"range_min": "near"}, ".range_min: expected float32, got 'near'"),
        (SCAN, {"range_min": 1e300}, ".range_min: expected float32, got 1e+300"),
        (SCAN, {"range_min": "a" * 100}, f".range_min: expected float32, got '{'a' * 56}..."),
        (SCAN, {"ranges": [1.0, 1e300]}, ".ranges[1]: expected float32, got 1e+300"),
        (SCAN, {"ranges": [1.0, None]}, ".ranges: expected an array of float32, got [1.0, None]"),
        (SCAN, {"ranges": [[1.0], [2.0]]}, ".ranges: expected shape (N,), got (2, 1)"),
        (SCAN, {"ranges": 1.0}, ".ranges: expected an array of float32, got 1.0"),
        (SCAN, {"header": {"frame_id": 7}}, ".header.frame_id: expected text without NUL, got 7"),
        (SCAN, {"header": {"frame_id": "a\0b"}}, "expected text without NUL"),
        (SCAN, {"header": {"frame_id": "\ud800"}}, "expected text that UTF-8 can encode"),
        (SCAN, {"header": []}, ".header: expected a mapping or a std_msgs/msg/Header, got []"),
        (SCAN, 5, "expected a mapping or a sensor_msgs/msg/LaserScan, got 5"),
        ("nav_msgs/msg/Path", {"poses": [{}, {"pose": 1}]}, ".poses[1].pose: expected a mapping"),
        ("nav_msgs/msg/Path", {"poses": "ab"}, ".poses: expected a sequence of geometry_msgs/msg/"),
        ("nav_msgs/msg/OccupancyGrid", {"data": [-129]}, ".data[0]: expected int8 (-128 to 127)"),
        ("nav_msgs/msg/OccupancyGrid", {"data": [0.5]}, ".data[0]: expected int8 (-128 to 127)"),
        ("std_msgs/msg/UInt64MultiArray", {"data": np.array([-1])}, ".data[0]: expected uint64"),
        ("std_msgs/msg/Bool", {"data": 2}, ".data: expected bool (true or false), got 2"),
        ("geometry_msgs/msg/Point", (1, 2), "expected the 3 numbers of a geometry_msgs/msg/Point"),
        (
            "geometry_msgs/msg/Polygon",
            {"points": np.ones((2, 2))},
            ".points: expected shape (N, 3)",
        ),
        (
            "geometry_msgs/msg/PoseWithCovariance",
            {"covariance": [0]},
            "expected 36 elements, got 1",
        ),
        ("shape_msgs/msg/SolidPrimitive", {"dimensions": [1] * 4}, "expected at most 3 elements"),
    ],
)
def test_an_invalid_value_is_refused_with_its_path_and_valid_values(
    type_name: str, values: dict[str, Any], words: str
) -> None:
    with pytest.raises(EncodeError, match=re.escape(words)) as refusal:
        encode(type_name, values)
    assert str(refusal.value).startswith(type_name)
    assert str(refusal.value).endswith((".", "?"))


def test_the_bound_of_a_string_is_enforced() -> None:
    register("odd_msgs/msg/Bounded", "string<=3 short")
    assert encode("odd_msgs/msg/Bounded", {"short": "abc"}).endswith(b"\4\0\0\0abc\0")
    with pytest.raises(EncodeError, match="short: expected text of at most 3 bytes, got 'four'"):
        encode("odd_msgs/msg/Bounded", {"short": "four"})


def test_numbers_may_come_as_arrays_bytes_or_tuples() -> None:
    data = np.arange(4, dtype=np.float64)
    assert encode(SCAN, {"ranges": data}) == encode(SCAN, {"ranges": [0, 1.0, 2, 3]})
    cloud, points = "sensor_msgs/msg/PointCloud2", [(1.0, 2.0, 3.0), (4.0, 5.0, 6.0)]
    assert encode(cloud, {"data": b"ab"}) == encode(cloud, {"data": [97, 98]})
    named = [dict(zip("xyz", point, strict=True)) for point in points]
    for several in (points, np.array(points), named):
        polygon = decode(
            "geometry_msgs/msg/Polygon", encode("geometry_msgs/msg/Polygon", {"points": several})
        )
        assert polygon.points.tolist() == [list(point) for point in points]


@pytest.mark.parametrize("frame_ids", [["map"] * 5, ["map", "odom", "map"], ["base_link"], []])
def test_poses_in_arrays_are_encoded_as_those_one_by_one(frame_ids: list[str]) -> None:
    count = len(frame_ids)
    poses = PoseStampedSequence(
        np.arange(3.0 * count).reshape(-1, 3),
        np.ones((count, 4)),
        np.arange(count) * 1_500_000_000 - 7,
        frame_ids,
    )
    for type_name, several in (
        ("nav_msgs/msg/Path", poses),
        ("geometry_msgs/msg/PoseArray", PoseSequence(poses.positions, poses.orientations)),
    ):
        values = {"header": {"frame_id": "map"}}
        one_by_one = encode(type_name, values | {"poses": list(several)})
        assert encode(type_name, values | {"poses": several}) == one_by_one


def test_a_type_registered_again_is_encoded_by_its_new_definition() -> None:
    register("odd_msgs/msg/Changing", "uint8 a")
    assert encode("odd_msgs/msg/Changing", {"a": 1}) == b"\0\1\0\0\1"
    register("odd_msgs/msg/Changing", "uint16 a")
    assert encode("odd_msgs/msg/Changing", {"a": 1}) == b"\0\1\0\0\1\0"


def test_fields_that_are_left_out_have_the_default_of_the_definition() -> None:
    pose = decode("geometry_msgs/msg/PoseStamped", encode("geometry_msgs/msg/PoseStamped"))
    assert pose == message_class("geometry_msgs/msg/PoseStamped")()
    assert pose.pose.orientation.w == 1.0
