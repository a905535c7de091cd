"""Whatever bytes arrive, decoding ends in a message or in one sentence."""

from __future__ import annotations

import re
import struct
import tracemalloc
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rosbags_messages import plain, random_message, rosbags_store

from webviz.data.messages import DecodeError, UnknownTypeError, decode, encode, peek_header
from webviz.data.messages import cdr as cdr_module

TYPES = [
    "geometry_msgs/msg/PoseArray",
    "map_msgs/msg/OccupancyGridUpdate",
    "nav_msgs/msg/OccupancyGrid",
    "nav_msgs/msg/Path",
    "rcl_interfaces/msg/ParameterValue",
    "sensor_msgs/msg/JointState",
    "sensor_msgs/msg/LaserScan",
    "sensor_msgs/msg/PointCloud2",
    "std_msgs/msg/String",
    "tf2_msgs/msg/TFMessage",
    "trajectory_msgs/msg/JointTrajectory",
    "visualization_msgs/msg/MarkerArray",
]
SEEDS = st.integers(0, 2**32 - 1)
SENTENCE = re.compile(r"Not a [\w/]+: .+ \(at byte \d+ of \d+\)\.")


def _decode_or_refuse(type_name: str, cdr: bytes) -> None:
    for read in (decode, peek_header):
        refusal = None
        try:
            read(type_name, cdr)
        except DecodeError as error:
            refusal = str(error)
        assert refusal is None or SENTENCE.fullmatch(refusal)


@pytest.mark.parametrize("type_name", TYPES)
@settings(deadline=None)
@given(cdr=st.binary(max_size=200))
def test_random_bytes_are_decoded_or_refused(type_name: str, cdr: bytes) -> None:
    _decode_or_refuse(type_name, cdr)
    _decode_or_refuse(type_name, b"\x00\x01\x00\x00" + cdr)
    _decode_or_refuse(type_name, b"\x00\x00\x00\x00" + cdr)


@pytest.mark.parametrize("type_name", TYPES)
@settings(deadline=None)
@given(seed=SEEDS, where=st.floats(0, 1, exclude_max=True), byte=st.integers(0, 255))
def test_a_message_with_a_changed_byte_is_decoded_or_refused(
    type_name: str, seed: int, where: float, byte: int
) -> None:
    message = random_message(type_name, Random(seed))
    cdr = bytearray(rosbags_store().serialize_cdr(message, type_name))
    cdr[int(where * len(cdr))] = byte
    _decode_or_refuse(type_name, bytes(cdr))


@pytest.mark.parametrize("type_name", TYPES)
def test_a_message_cut_off_anywhere_is_refused(type_name: str) -> None:
    for seed in range(5):
        message = random_message(type_name, Random(seed))
        cdr = bytes(rosbags_store().serialize_cdr(message, type_name))
        for length in range(len(cdr)):
            with pytest.raises(DecodeError, match=SENTENCE):
                decode(type_name, cdr[:length])


@pytest.mark.parametrize("type_name", TYPES)
def test_padding_behind_a_message_is_ignored(type_name: str) -> None:
    message = random_message(type_name, Random(2))
    cdr = bytes(rosbags_store().serialize_cdr(message, type_name))
    assert plain(decode(type_name, cdr + bytes(7))) == plain(message)


@pytest.mark.parametrize("claimed", [2**32 - 1, 2**31, 10**6])
@pytest.mark.parametrize(
    ("type_name", "before"),
    [
        ("geometry_msgs/msg/PoseArray", 16),
        ("nav_msgs/msg/Path", 16),
        ("sensor_msgs/msg/JointState", 16),
        ("sensor_msgs/msg/LaserScan", 44),
        ("std_msgs/msg/String", 0),
        ("tf2_msgs/msg/TFMessage", 0),
        ("trajectory_msgs/msg/JointTrajectory", 20),
        ("visualization_msgs/msg/MarkerArray", 0),
    ],
)
def test_a_length_that_lies_is_refused_without_allocating_it(
    type_name: str, before: int, claimed: int
) -> None:
    header = struct.pack("<iII", 1, 2, 1) + b"\0\0\0\0"
    cdr = b"\x00\x01\x00\x00" + (header + bytes(before))[:before] + struct.pack("<I", claimed)
    cdr += bytes(200)
    with pytest.raises(DecodeError):  # builds the decoder, which may allocate
        decode(type_name, cdr)
    tracemalloc.start()
    try:
        with pytest.raises(DecodeError, match=SENTENCE):
            decode(type_name, cdr)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < 100_000


def test_text_that_is_not_utf8_shows_replacement_characters() -> None:
    cdr = b"\x00\x01\x00\x00\x05\x00\x00\x00M\xfcll\x00"
    assert decode("std_msgs/msg/String", cdr).data == "M\ufffdll"


def test_a_frame_id_that_is_not_utf8_shows_replacement_characters() -> None:
    message = random_message("tf2_msgs/msg/TFMessage", Random(0))
    message.transforms[0].header.frame_id = "m#p"
    cdr = bytes(rosbags_store().serialize_cdr(message, "tf2_msgs/msg/TFMessage"))
    decoded = decode("tf2_msgs/msg/TFMessage", cdr.replace(b"m#p", b"m\xe4p"))
    assert decoded.transforms[0].parent == "m\ufffdp"


@pytest.mark.parametrize("length", [b"\x00\x00\x00\x00", b"\x01\x00\x00\x00\x00"])
def test_an_empty_string_may_come_without_its_nul(length: bytes) -> None:
    assert decode("std_msgs/msg/String", b"\x00\x01\x00\x00" + length).data == ""


def test_a_string_without_its_nul_is_refused() -> None:
    with pytest.raises(DecodeError, match="does not end in NUL"):
        decode("std_msgs/msg/String", b"\x00\x01\x00\x00\x02\x00\x00\x00hi")


@pytest.mark.parametrize("encapsulation", ["0002", "0003", "0006", "0007", "0008", "0009", "ffff"])
def test_other_encodings_than_plain_cdr_are_refused_by_name(encapsulation: str) -> None:
    cdr = bytes.fromhex(encapsulation) + b"\x00\x00\x03\x00\x00\x00hi\x00"
    with pytest.raises(DecodeError, match=f"encapsulation 0x{encapsulation} is not plain CDR"):
        decode("std_msgs/msg/String", cdr)


def test_a_bool_that_is_neither_0_nor_1_is_true() -> None:
    cdr = bytes.fromhex("00010000 02")
    assert decode("std_msgs/msg/Bool", cdr).data is True


@pytest.mark.parametrize("name", ["nowhere_msgs/msg/Nothing", "String", "", "a/b/c/d", "x y/Z"])
def test_an_unknown_type_is_named_in_one_sentence(name: str) -> None:
    for read in (decode, peek_header):
        with pytest.raises(UnknownTypeError, match=re.escape(name) or "''"):
            read(name, b"\x00\x01\x00\x00\x00\x00\x00\x00")


def test_strings_of_a_message_have_a_limit_together(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cdr_module, "MAX_TEXT", 2 << 20)
    name, one = "sensor_msgs/msg/JointState", "x" * (1 << 20)
    assert len(decode(name, encode(name, {"name": [one, "y"]})).name[0]) == 1 << 20
    with pytest.raises(DecodeError, match=r"^This .* its strings have more than 2 MB\.$"):
        decode(name, encode(name, {"name": [one, one]}))


def test_elements_of_sequences_of_objects_are_limited(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cdr_module, "MAX_ELEMENTS", 3)
    name = "sensor_msgs/msg/JointState"
    numbers = [0.0] * 100
    assert len(decode(name, encode(name, {"name": ["a"] * 3, "position": numbers})).position) == 100
    with pytest.raises(DecodeError, match=r"its sequences have more than 3 elements\.$"):
        decode(name, encode(name, {"name": ["a"] * 4}))


@pytest.mark.parametrize("frame", ["", "map", "odom", "base_link", "camera_link_17"])
def test_a_path_of_equal_frames_that_is_cut_off_is_refused(frame: str) -> None:
    for count in range(2, 6):
        poses = [{"header": {"frame_id": frame}}] * count
        cdr = encode("nav_msgs/msg/Path", {"poses": poses})
        assert decode("nav_msgs/msg/Path", cdr).poses.frame_ids == [frame] * count
        for size in range(20, len(cdr)):
            with pytest.raises(DecodeError):
                decode("nav_msgs/msg/Path", cdr[:size])


def test_the_error_of_a_truncated_trajectory_names_the_field() -> None:
    cdr = encode("trajectory_msgs/msg/JointTrajectory", {"points": [{"positions": [1.0, 2.0]}]})
    results = set[str]()
    for size in range(4, len(cdr)):
        with pytest.raises(DecodeError) as excinfo:
            decode("trajectory_msgs/msg/JointTrajectory", cdr[:size])
        results.add(str(excinfo.value).partition(": ")[2].partition(" (at")[0])
    assert "2 elements of float64 are longer than the rest" in results
