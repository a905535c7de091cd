"""Decoded messages equal what independent implementations make of the same bytes."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from itertools import product
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from known_types import ROS_TYPES, TYPES, ros_classes
from rosbags.highlevel import AnyReader
from rosbags.typesys.store import Typestore
from rosbags_messages import plain, random_message, rosbags_store

from webviz.data.messages import DecodeError, decode, encode, message_class, peek_header
from webviz.data.messages.classes import WRITTEN, attribute
from webviz.data.messages.markers import NOTHING, Marker
from webviz.data.messages.typestore import constants, fields

BAGS = Path(__file__).parents[3] / "../shared/data/bags"
BUSY_TYPES = [
    "geometry_msgs/msg/PoseArray",
    "geometry_msgs/msg/PoseStamped",
    "geometry_msgs/msg/PoseWithCovarianceStamped",
    "map_msgs/msg/OccupancyGridUpdate",
    "nav_msgs/msg/OccupancyGrid",
    "nav_msgs/msg/Odometry",
    "nav_msgs/msg/Path",
    "rosgraph_msgs/msg/Clock",
    "sensor_msgs/msg/JointState",
    "sensor_msgs/msg/LaserScan",
    "sensor_msgs/msg/PointCloud2",
    "std_msgs/msg/String",
    "tf2_msgs/msg/TFMessage",
    "trajectory_msgs/msg/JointTrajectory",
    "visualization_msgs/msg/MarkerArray",
]
SEEDS = st.integers(0, 2**32 - 1)


@pytest.mark.parametrize("little_endian", [True, False], ids=["little", "big"])
@pytest.mark.parametrize("type_name", BUSY_TYPES)
@settings(deadline=None)
@given(seed=SEEDS)
def test_a_busy_type_is_decoded_as_rosbags_decodes_it(
    type_name: str, little_endian: bool, seed: int
) -> None:
    message = random_message(type_name, Random(seed))
    cdr = bytes(rosbags_store().serialize_cdr(message, type_name, little_endian=little_endian))
    assert plain(decode(type_name, cdr)) == plain(message)


@pytest.mark.parametrize("package", TYPES)
def test_every_known_type_is_decoded_as_rosbags_decodes_it(package: str) -> None:
    for type_name, seed in product(TYPES[package], range(10)):
        message = random_message(type_name, Random(seed))
        cdr = bytes(rosbags_store().serialize_cdr(message, type_name))
        assert plain(decode(type_name, cdr)) == plain(message), type_name


@pytest.mark.filterwarnings("ignore:module 'sre_:DeprecationWarning")  # ROS's own imports
@pytest.mark.parametrize("package", ROS_TYPES)
def test_messages_serialised_by_ros_are_decoded(package: str) -> None:
    serialization = pytest.importorskip("rclpy.serialization")
    for (type_name, ros_class), seed in product(ros_classes(package).items(), range(10)):
        message = random_message(type_name, Random(seed))
        cdr = bytes(rosbags_store().serialize_cdr(message, type_name))
        ros_message = serialization.deserialize_message(cdr, ros_class)
        from_ros = serialization.serialize_message(ros_message)
        assert plain(decode(type_name, from_ros)) == plain(message), type_name


@pytest.mark.parametrize(
    ("bag", "topic"),
    [("nav2_turtlebot.mcap", "/tf"), ("macfirst_floor_take_2", "/scan")],
)
def test_messages_of_real_robots_are_decoded_as_rosbags_decodes_them(bag: str, topic: str) -> None:
    if not (BAGS / bag).exists():
        pytest.skip(f"the recorded bag {bag} is not on this machine")
    compared: dict[str, int] = {}
    with AnyReader([BAGS / bag], default_typestore=rosbags_store()) as reader:
        for connection, _, cdr in reader.messages():
            name = connection.msgtype
            if name in rosbags_store().fielddefs and compared.setdefault(connection.topic, 0) < 20:
                compared[connection.topic] += 1
                expected = plain(rosbags_store().deserialize_cdr(cdr, name))
                np.testing.assert_equal(plain(decode(name, cdr)), expected)
    assert compared[topic] == 20


def test_classes_written_by_hand_have_the_fields_and_constants_of_their_definitions() -> None:
    for type_name in WRITTEN:
        struct_class = message_class(type_name)
        assert list(struct_class.__struct_fields__) == [
            attribute(f.name) for f in fields(type_name)
        ]
        for name, value in constants(type_name).items():
            assert getattr(struct_class, name) == value, type_name


@pytest.mark.parametrize("package", TYPES)
def test_default_messages_have_the_types_that_decoding_gives(package: str) -> None:
    for type_name in TYPES[package]:
        message = random_message(type_name, Random(1))
        decoded = decode(type_name, bytes(rosbags_store().serialize_cdr(message, type_name)))
        default = message_class(type_name)()
        for name in default.__struct_fields__:
            ours, theirs = getattr(default, name), getattr(decoded, name)
            assert type(ours) is type(theirs), (type_name, name)
            if isinstance(ours, np.ndarray):
                assert (ours.dtype, ours.shape[1:]) == (theirs.dtype, theirs.shape[1:])


def test_the_default_rotation_is_the_identity() -> None:
    assert message_class("geometry_msgs/msg/PoseStamped")().pose.orientation.w == 1.0


@pytest.mark.parametrize("count", [0, 1, 2, 500])
@pytest.mark.parametrize("frame_id", ["", "map", "odom", "base_footprint"])
def test_poses_of_one_frame_are_views_of_the_received_bytes(count: int, frame_id: str) -> None:
    path = _path(rosbags_store(), [frame_id] * count)
    cdr = bytes(rosbags_store().serialize_cdr(path, "nav_msgs/msg/Path"))
    poses = decode("nav_msgs/msg/Path", cdr).poses
    assert plain(poses) == plain(path.poses)
    assert poses.positions.shape == (count, 3)
    assert poses.orientations.shape == (count, 4)
    assert poses.frame_ids == [frame_id] * count
    assert not poses.positions.flags.writeable
    if count > 1:
        assert np.shares_memory(poses.positions, np.frombuffer(cdr, np.uint8))


@pytest.mark.parametrize(
    "frame_ids",
    [
        ["map", "odom"],
        ["map", "map", "mop"],
        ["a", "abcdefgh", "a"],
        ["map", ""],
        ["map", "map\0and something behind the NUL"],
    ],
)
def test_poses_of_different_frames_keep_theirs(frame_ids: list[str]) -> None:
    path = _path(rosbags_store(), frame_ids)
    cdr = bytes(rosbags_store().serialize_cdr(path, "nav_msgs/msg/Path"))
    poses = decode("nav_msgs/msg/Path", cdr).poses
    assert poses.frame_ids == frame_ids
    assert plain(poses) == plain(path.poses)


@pytest.mark.parametrize("little_endian", [True, False], ids=["little", "big"])
@pytest.mark.parametrize("names", [[], ["a"], ["a", "bcdefgh"]])
@pytest.mark.parametrize(
    "lengths",
    [
        [(0, 0, 0, 0)] * 3,
        [(2, 0, 0, 0)] * 3,
        [(0, 1, 0, 3)] * 3,
        [(2, 2, 2, 2)] * 1000,
        [(2, 0, 0, 0), *[(2, 2, 2, 0)] * 3],
        [*[(2, 2, 2, 0)] * 3, (2, 0, 0, 0)],
    ],
)
def test_points_of_a_trajectory_are_decoded_as_rosbags_decodes_them(
    lengths: list[tuple[int, int, int, int]], names: list[str], little_endian: bool
) -> None:
    kinds = {name.rpartition("/")[2]: kind for name, kind in rosbags_store().types.items()}
    points = [
        kinds["JointTrajectoryPoint"](
            *(number + np.arange(length) / 8 for length in each),
            kinds["Duration"](number - 1, 10**9 - 1),
        )
        for number, each in enumerate(lengths)
    ]
    name = "trajectory_msgs/msg/JointTrajectory"
    header = kinds["Header"](kinds["Time"](1, 2), "map")
    joint_trajectory: Any = kinds["JointTrajectory"]
    trajectory = joint_trajectory(header, names, points)
    cdr = bytes(rosbags_store().serialize_cdr(trajectory, name, little_endian=little_endian))
    decoded = decode(name, cdr).points
    assert plain(decoded) == plain(points)
    assert not decoded.numbers.flags.writeable
    numbers, rows = decoded.positions(2, 2)
    assert numbers.tolist() == [index for index in range(2) if lengths[index][0] == 2]
    assert rows.tolist() == [points[index].positions.tolist() for index in numbers]
    assert encode(name, decode(name, cdr)) == bytes(rosbags_store().serialize_cdr(trajectory, name))


def _path(store: Typestore, frame_ids: list[str]) -> Any:
    types = {name.rpartition("/")[2]: kind for name, kind in store.types.items()}
    poses = [
        types["PoseStamped"](
            types["Header"](types["Time"](number, 10**9 - 1), frame_id),
            types["Pose"](
                types["Point"](number, 0.5, -1.0), types["Quaternion"](0.0, 0.6, 0.0, 0.8)
            ),
        )
        for number, frame_id in enumerate(frame_ids)
    ]
    path: Any = store.types["nav_msgs/msg/Path"]
    return path(types["Header"](types["Time"](1, 2), "map"), poses)


def test_large_arrays_are_read_only_views_of_the_received_bytes() -> None:
    for name, attribute_name in [("LaserScan", "ranges"), ("PointCloud2", "data")]:
        message = random_message(f"sensor_msgs/msg/{name}", Random(3))
        setattr(message, attribute_name, np.ones(1000, getattr(message, attribute_name).dtype))
        cdr = bytes(rosbags_store().serialize_cdr(message, f"sensor_msgs/msg/{name}"))
        array = getattr(decode(f"sensor_msgs/msg/{name}", cdr), attribute_name)
        assert np.shares_memory(array, np.frombuffer(cdr, np.uint8))
        assert not array.flags.writeable


def test_arrays_in_the_other_byte_order_are_native_and_read_only_too() -> None:
    path = _path(rosbags_store(), ["map", "map"])
    cdr = bytes(rosbags_store().serialize_cdr(path, "nav_msgs/msg/Path", little_endian=False))
    poses = decode("nav_msgs/msg/Path", cdr).poses
    data = decode("std_msgs/msg/Float32MultiArray", bytes.fromhex(f"{0:024x}000000013f800000")).data
    assert data.tolist() == [1.0]
    for array in (poses.positions, poses.stamps_ns, data):
        assert array.dtype.isnative
        assert not array.flags.writeable


@pytest.mark.parametrize("little_endian", [True, False], ids=["little", "big"])
@pytest.mark.parametrize("package", TYPES)
def test_peeking_gives_the_header_that_decoding_gives(package: str, little_endian: bool) -> None:
    for type_name in TYPES[package]:
        message = random_message(type_name, Random(7))
        cdr = rosbags_store().serialize_cdr(message, type_name, little_endian=little_endian)
        first = fields(type_name)[0]
        expected = None
        if (first.base, first.size) == ("std_msgs/msg/Header", None):
            header = getattr(decode(type_name, cdr), first.name)
            expected = header.frame_id, header.stamp_ns
        assert peek_header(type_name, cdr) == expected, type_name


def test_the_two_part_type_names_of_ros_1_and_bags_are_understood() -> None:
    cdr = b"\x00\x01\x00\x00\x03\x00\x00\x00hi\x00"
    assert decode("std_msgs/String", cdr).data == decode("std_msgs/msg/String", cdr).data == "hi"


def test_stamps_keep_every_nanosecond() -> None:
    cdr = b"\x00\x01\x00\x00" + (1_700_000_000).to_bytes(4, "little") + b"\x01\x00\x00\x00"
    assert decode("rosgraph_msgs/msg/Clock", cdr).clock.ns == 1_700_000_000_000_000_001
    assert decode("builtin_interfaces/msg/Duration", cdr).ns == 1_700_000_000_000_000_001


@pytest.mark.parametrize("kind", [bytes, bytearray, memoryview])
def test_bytes_may_come_in_any_kind_of_buffer_and_arrays_are_read_only(
    kind: Callable[[bytes], bytes | bytearray | memoryview],
) -> None:
    cdr = bytes.fromhex("00010000 00000000 00000000 02000000 0000803f 00000040")
    message = decode("std_msgs/msg/Float32MultiArray", kind(cdr))
    assert message.data.tolist() == [1.0, 2.0]
    assert not message.data.flags.writeable


def test_markers_of_texts_make_no_empty_lists_of_their_own() -> None:
    """Hold what keeps many thousands of them in a message small."""
    name = "visualization_msgs/msg/MarkerArray"
    texts = [{"type": Marker.TEXT_VIEW_FACING, "text": text} for text in ("a", "bc")]
    for content in decode(name, encode(name, {"markers": texts})).markers.contents:
        assert content.points is NOTHING.points
        assert content.colors is NOTHING.colors
        assert content.uv_coordinates is NOTHING.uv_coordinates
        assert content.texture is NOTHING.texture


@given(
    st.lists(st.sampled_from(["", "x", "abc", "a long one", "wall"]), min_size=1, max_size=5),
    st.integers(0, 40),
    st.lists(st.sampled_from(["", "ab"]), max_size=5),
    st.integers(0, 2**31 - 1),
)
def test_markers_that_repeat_are_read_as_each_by_itself(
    cycle: list[str], times: int, others: list[str], cut: int
) -> None:
    texts = [*others, *cycle * times, *others, *cycle * 3]
    markers = [
        {"ns": text, "id": i, "text": text[: i % 3], "points": [{"x": i}] * (len(text) % 2)}
        for i, text in enumerate(texts)
    ]
    name = "visualization_msgs/msg/Marker"
    array = encode(f"{name}Array", {"markers": markers})
    decoded = decode(f"{name}Array", array).markers
    assert [encode(name, each) for each in decoded] == [encode(name, each) for each in markers]
    with contextlib.suppress(DecodeError):
        decode(f"{name}Array", array[: cut % len(array)])
