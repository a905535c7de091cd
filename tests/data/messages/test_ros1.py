"""Messages of ROS 1, byte by byte; `tests/sources/test_ros1_bags.py` reads them from bags."""

from __future__ import annotations

import struct
from typing import Any

import pytest

from webviz.data.messages import DecodeError, DefinitionError, decode, register, ros1
from webviz.data.messages.ros1 import TRANSFORMS, Ros1Type, transforms_to_cdr

NAME = "old_msgs/msg/Mixed"
TEXT = """time at
duration ripe
string[] names
uint8[3] rgb
float32[] numbers
old_msgs/Part[2] parts
bool last
""" + ("=" * 80 + "\nMSG: old_msgs/Part\nchar letter\nint64 size\n")
HEADER = "uint32 seq\ntime stamp\nstring frame_id\n"
HEAD = struct.pack("<III", 7, 1, 2) + struct.pack("<I", 3) + b"map"


def mixed(seconds: int = 5, nanoseconds: int = 6) -> bytes:
    return b"".join(
        [
            struct.pack("<IiiiI", seconds, nanoseconds, -3, 4, 2),
            *(struct.pack("<I", len(name)) + name for name in (b"a\xfc", b"bcd")),
            bytes([1, 2, 3]),
            struct.pack("<I2f", 2, 0.5, -1.5),
            struct.pack("<BqBq", 65, -1, 66, 2**40),
            b"\1",
        ]
    )


def example_type() -> Ros1Type:
    ros1_type = Ros1Type(NAME, TEXT)
    if text := ros1_type.definition():
        register(NAME, text)
    return ros1_type


def read(cdr: bytes) -> Any:
    return decode(NAME, cdr)


def test_every_kind_of_field_is_converted() -> None:
    message = read(example_type().to_cdr(mixed()))
    assert (message.at.ns, message.ripe.sec, message.ripe.nanosec) == (5_000_000_006, -3, 4)
    assert message.names == ["a\ufffd", "bcd"]
    assert bytes(message.rgb) == b"\1\2\3"
    assert message.numbers.tolist() == [0.5, -1.5]
    assert [(part.letter, part.size) for part in message.parts] == [(65, -1), (66, 2**40)]
    assert message.last is True


def test_times_that_ros_2_does_not_have_are_the_nearest() -> None:
    message = read(example_type().to_cdr(mixed(2**32 - 2, -1)))
    assert (message.at.sec, message.at.nanosec) == (-2, 0)


def test_a_message_that_is_cut_off_is_refused() -> None:
    ros1_type, whole = example_type(), mixed()
    for end in range(len(whole)):
        with pytest.raises(DecodeError, match=f"^{NAME} of ROS 1 is damaged"):
            ros1_type.to_cdr(whole[:end])
    for count in (100_000, 2**32 - 1):
        damaged = whole[:16] + struct.pack("<I", count) + whole[20:]
        with pytest.raises(DecodeError, match="damaged"):
            ros1_type.to_cdr(damaged)


def test_lengths_that_lie_at_the_end_are_refused() -> None:
    nothing = "old_msgs/Nothing[] many\n" + "=" * 80 + "\nMSG: old_msgs/Nothing\n"
    for ros1_type, data in (
        (Ros1Type("std_msgs/msg/String", "string data\n"), struct.pack("<I", 4) + b"abc"),
        (Ros1Type("old_msgs/msg/Nothings", nothing), struct.pack("<I", 2**32 - 1)),
    ):
        with pytest.raises(DecodeError, match="damaged"):
            ros1_type.to_cdr(data)


def test_fields_that_ros_2_dropped_or_renamed_are_converted() -> None:
    nested = "=" * 80 + f"\nMSG: std_msgs/Header\n{HEADER}"
    ros1_type = Ros1Type(
        "geometry_msgs/msg/PointStamped",
        f"Header header\nPoint point\n{nested}"
        + ("=" * 80 + "\nMSG: geometry_msgs/Point\nfloat64 X\nfloat64 y\nfloat64 z\n"),
    )
    assert ros1_type.definition() == ""
    message = decode(ros1_type.name, ros1_type.to_cdr(HEAD + struct.pack("<3d", 1.0, 2.0, 3.0)))
    assert (message.header.frame_id, message.header.stamp_ns) == ("map", 1_000_000_002)
    assert (message.point.x, message.point.y, message.point.z) == (1.0, 2.0, 3.0)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("old_msgs/Missing part\n", "contains a old_msgs/msg/Missing, whose definition is missing"),
        ("old_msgs/Odd part\n", "old_msgs/msg/Odd cannot contain itself"),
        ("float64 = (\n", "not valid .msg text"),
    ],
)
def test_a_definition_that_is_incomplete_or_endless_is_refused(text: str, sentence: str) -> None:
    with pytest.raises(DefinitionError, match=sentence):
        Ros1Type("old_msgs/msg/Odd", text)


TF_TEXT = (
    "geometry_msgs/TransformStamped[] transforms\n"
    + ("=" * 80 + "\nMSG: geometry_msgs/TransformStamped\nstd_msgs/Header header\n")
    + "string child_frame_id\ngeometry_msgs/Transform transform\n"
    + ("=" * 80 + f"\nMSG: std_msgs/Header\n{HEADER}")
    + ("=" * 80 + "\nMSG: geometry_msgs/Transform\n")
    + "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"
    + ("=" * 80 + "\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n")
    + ("=" * 80 + "\nMSG: geometry_msgs/Quaternion\n")
    + "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"
)


def transforms(*names: tuple[bytes, bytes], seconds: int = 5, nanoseconds: int = 6) -> bytes:
    """Return a message of ROS 1."""
    parts = [struct.pack("<I", len(names))]
    for number, (frame, child) in enumerate(names):
        parts.append(struct.pack("<III", number, seconds & 0xFFFFFFFF, nanoseconds & 0xFFFFFFFF))
        parts += [struct.pack("<I", len(each)) + each for each in (frame, child)]
        parts.append(struct.pack("<7d", *(number + place for place in range(7))))
    return b"".join(parts)


ODD_NAMES = [
    [],
    [(b"map", b"base")],
    [(b"", b"a"), (b"ab", b"abc"), (b"abcd", b"abcde")],
    [(b"a\xfcb", "ü".encode()), (b"nul\0l", b"\0")],
]


@pytest.mark.parametrize("names", ODD_NAMES)
@pytest.mark.parametrize(("seconds", "nanoseconds"), [(5, 6), (-1, -1), (2**31 - 1, 10**9)])
def test_transforms_are_converted_as_every_message(
    names: list[tuple[bytes, bytes]], seconds: int, nanoseconds: int
) -> None:
    data = transforms(*names, seconds=seconds, nanoseconds=nanoseconds)
    general = Ros1Type(TRANSFORMS, TF_TEXT)  # converts its first message as every type does
    assert transforms_to_cdr(data) == general.to_cdr(data)


def counted(monkeypatch: pytest.MonkeyPatch, name: str) -> list[str]:
    """Note each call of a function of `ros1`."""
    calls: list[str] = []
    function = getattr(ros1, name)
    monkeypatch.setattr(ros1, name, lambda *args: calls.append(name) or function(*args))
    return calls


def test_transforms_are_converted_the_fast_way_once_that_is_known_to_fit(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    general, fast = counted(monkeypatch, "encode"), counted(monkeypatch, "transforms_to_cdr")
    ros1_type = Ros1Type(TRANSFORMS, TF_TEXT)
    ros1_type.to_cdr(transforms())
    assert fast == []  # an empty message shows nothing
    data = transforms((b"map", b"base"))
    first = ros1_type.to_cdr(data)
    assert (len(general), len(fast)) == (2, 1)
    assert ros1_type.to_cdr(data) == first
    assert (len(general), len(fast)) == (2, 2)
    for size in range(len(data)):
        with pytest.raises(DecodeError):
            ros1_type.to_cdr(data[:size])


def test_transforms_of_another_definition_are_read_by_that(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fast = counted(monkeypatch, "transforms_to_cdr")
    text = TF_TEXT.replace("string child_frame_id\n", "string child_frame_id\nint32 extra\n")
    data = transforms((b"map", b"base"))
    data = data[:-56] + struct.pack("<i", 9) + data[-56:]
    other = Ros1Type(TRANSFORMS, text)
    for _ in range(2):
        (transform,) = decode(TRANSFORMS, other.to_cdr(data)).transforms
        assert (transform.parent, transform.child, transform.translation) == (
            "map",
            "base",
            (0.0, 1.0, 2.0),
        )
    assert len(fast) == 1, "It was found not to fit."
