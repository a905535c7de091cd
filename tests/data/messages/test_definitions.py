"""Types known from the start, and types learnt while running."""

from __future__ import annotations

import importlib.util
import json
import sys
import time
from pathlib import Path

import pytest
from known_types import OURS

from webviz.data.messages import (
    KNOWN,
    DefinitionError,
    UnknownTypeError,
    decode,
    definition,
    encode,
    message_class,
    peek_header,
    register,
    type_exists,
    type_hash,
)
from webviz.data.messages.decoders import decoder
from webviz.sources.bridge.definitions import Definitions

CDR = b"\x00\x01\x00\x00"
WHEEL = "=" * 80 + "\nMSG: prepared_msgs/Wheel\n{} turns\n"


def test_types_of_displays_are_known_without_ros() -> None:
    for name in ["map_msgs/OccupancyGridUpdate", "tf2_msgs/msg/TFMessage", *OURS]:
        assert type_exists(name)


@pytest.mark.parametrize("name", ["nowhere_msgs/msg/Nothing", "LaserScan", "a b/msg/C", ""])
def test_undefined_types_do_not_exist(name: str) -> None:
    assert not type_exists(name)
    for ask in (definition, type_hash, message_class):
        with pytest.raises(UnknownTypeError):
            ask(name)


@pytest.mark.parametrize("name", OURS)
def test_every_definition_of_ours_is_complete(name: str) -> None:
    register(name, definition(name))
    assert message_class(name)() is not None


def test_the_hash_of_tf_messages_is_the_one_of_ros() -> None:
    assert type_hash("tf2_msgs/msg/TFMessage") == (
        "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"
    )


@pytest.mark.parametrize(
    "name", ["sensor_msgs/msg/LaserScan", "visualization_msgs/msg/Marker", "std_msgs/msg/Empty"]
)
def test_hashes_are_those_that_ros_installs(name: str) -> None:
    package, _, message = name.split("/")
    installed = Path(sys.prefix) / "share" / package / "msg" / f"{message}.json"
    if importlib.util.find_spec(package) is None or not installed.exists():
        pytest.skip(f"{package} is not installed")
    hashes = json.loads(installed.read_text())["type_hashes"]
    assert type_hash(name) in [entry["hash_string"] for entry in hashes]


def test_a_definition_is_msg_text_followed_by_the_types_it_holds() -> None:
    own, *parts = definition("geometry_msgs/PoseStamped").split("=" * 80 + "\nMSG: ")
    assert own == "std_msgs/Header header\ngeometry_msgs/Pose pose\n"
    assert parts[0].startswith("std_msgs/Header\n")


def test_a_registered_type_is_decoded_with_its_constants_and_the_types_it_holds() -> None:
    register(
        "test_msgs/msg/Wheel",
        "uint8 LEFT=1\nstd_msgs/Header header\nTyre[2] tyres\nint16 lambda\n"
        + "=" * 80
        + "\nMSG: test_msgs/Tyre\nuint8 wear\nfloat64 pressure\n",
    )
    cdr = CDR + bytes.fromhex(
        "01000000 02000000 01000000 00"
        "05 0000 000000000000f03f"
        "06 00000000000000 0000000000000040 ffff"
    )
    wheel = decode("test_msgs/msg/Wheel", cdr)
    assert [(tyre.wear, tyre.pressure) for tyre in wheel.tyres] == [(5, 1.0), (6, 2.0)]
    assert (wheel.LEFT, wheel.lambda_) == (1, -1)
    assert peek_header("test_msgs/msg/Wheel", cdr) == ("", 1_000_000_002)


def test_a_later_definition_replaces_an_earlier_one() -> None:
    register("test_msgs/msg/Changing", "uint8 old")
    assert decode("test_msgs/msg/Changing", CDR + b"\x07").old == 7
    register("test_msgs/msg/Changing", "std_msgs/Header header\nint8 new")
    assert message_class("test_msgs/msg/Changing").__struct_fields__ == ("header", "new")
    assert peek_header("test_msgs/msg/Changing", CDR + bytes(12)) == ("", 0)


def test_a_definition_may_not_change_a_type_that_webviz_has_a_class_for() -> None:
    with pytest.raises(DefinitionError, match="std_msgs/msg/Header"):
        register(
            "std_msgs/msg/Header", "uint32 seq\nbuiltin_interfaces/Time stamp\nstring frame_id"
        )
    assert message_class("std_msgs/msg/Header").__struct_fields__ == ("stamp", "frame_id")


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("float64 = nothing (", "is not valid .msg text"),
        ("test_msgs/Missing part", "contains a test_msgs/msg/Missing, whose definition is missing"),
        ("test_msgs/Bad part", "cannot contain itself"),
        ("Other a\n" + "=" * 80 + "\nMSG: test_msgs/Other\nBad[] b", "cannot contain itself"),
    ],
)
def test_a_definition_that_cannot_be_used_changes_nothing(text: str, reason: str) -> None:
    with pytest.raises(DefinitionError, match=reason):
        register("test_msgs/msg/Bad", text)
    assert not type_exists("test_msgs/msg/Bad")
    assert not type_exists("test_msgs/msg/Other")


def test_a_type_registered_again_is_decoded_by_its_new_definition() -> None:
    name = "changing_msgs/msg/Widening"
    cdr = b"\0\1\0\0" + bytes([1, 2, 0, 0])
    for kind, value in (("uint8", 1), ("uint16", 513)):
        register(name, f"{kind} number\n")
        assert decode(name, cdr).number == value


def test_a_type_that_loses_its_header_has_none_from_then_on() -> None:
    with_header = "std_msgs/Header header\nint32 number\n"
    name = "changing_msgs/msg/Changing"
    register(name, with_header)
    cdr = encode(name, {"header": {"frame_id": "map", "stamp": {"sec": 3}}, "number": 1})
    assert peek_header(name, cdr) == ("map", 3_000_000_000)
    register(name, "int32 number\n")
    assert peek_header(name, cdr) is None
    register(name, with_header)
    assert peek_header(name, cdr) == ("map", 3_000_000_000)


def test_a_decoder_is_reused_until_its_definition_changes() -> None:
    register("prepared_msgs/msg/Wheel", "int32 turns")
    built = decoder("prepared_msgs/msg/Wheel", "<", KNOWN)
    register("prepared_msgs/msg/Axle", "prepared_msgs/Wheel[2] wheels\n" + WHEEL.format("int32"))
    assert decoder("prepared_msgs/msg/Wheel", "<", KNOWN) is built
    register("prepared_msgs/msg/Axle", "prepared_msgs/Wheel[2] wheels\n" + WHEEL.format("int16"))
    assert decode("prepared_msgs/msg/Wheel", b"\0\1\0\0\1\0").turns == 1


def test_a_bridge_builds_decoders_in_its_own_thread() -> None:
    """It takes a second, in which the frame loop would draw nothing."""
    text = "".join(f"int32 a{number}\n" for number in range(19_999))
    definitions = Definitions()
    assert definitions.learn("/wide", "prepared_msgs/msg/Wide", text) == ""
    start_s = time.process_time()
    message = b"\0\1\0\0" + bytes(4 * 19_999)
    decode("prepared_msgs/msg/Wide", *definitions.read("/wide", message))
    assert time.process_time() - start_s < 0.1
