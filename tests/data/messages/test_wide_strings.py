"""Fields of type wstring, as Fast DDS writes them in 4 bytes a unit, and others in 2."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import pytest

from webviz.data.messages import DecodeError, decode, encode, register
from webviz.data.messages.stamps import shifted
from webviz.data.recordings import open_recording

NAME = "wide_msgs/msg/Wide"
TEXTS = ["", "a", "ab", "gr\xfcn", "\N{SNOWMAN}\N{GRINNING FACE}", "x" * 5000]
REPORT = Path(__file__).parents[4] / "shared/data/reports/B3w/wstring.mcap"


@pytest.fixture(autouse=True)
def registered() -> None:
    register(NAME, "uint8 first\nwstring text\nuint8 last\nwstring[] more\nwstring<=9 short\n")


def wide(text: str, size: int) -> bytes:
    """A wstring by hand, at an offset that 4 divides."""
    units = struct.unpack(f"<{len(text.encode('utf-16-le')) // 2}H", text.encode("utf-16-le"))
    return struct.pack(f"<I{len(units)}{'HI'[size // 4]}", len(units), *units)


@pytest.mark.parametrize("text", TEXTS)
def test_a_wstring_is_read_as_it_is_written(text: str) -> None:
    values = {"first": 1, "text": text, "last": 2, "more": [text, "", text], "short": text[:9]}
    message: Any = decode(NAME, encode(NAME, values))
    assert (message.first, message.text, message.last) == (1, text, 2)
    assert (message.more, message.short) == ([text, "", text], text[:9])


@pytest.mark.parametrize("size", [2, 4])
@pytest.mark.parametrize("text", ["", *TEXTS[2:]])
def test_both_sizes_of_characters_are_read(text: str, size: int) -> None:
    cdr = b"\0\1\0\0" + b"\1\0\0\0" + wide(text, size) + b"\7" + bytes(40)
    message: Any = decode(NAME, cdr)
    assert (message.text, message.last) == (text, 7)


@pytest.mark.parametrize("text", TEXTS)
def test_bytes_are_those_of_the_installed_ros(text: str) -> None:
    pytest.importorskip("rclpy", reason="rclpy is not installed")
    messages = pytest.importorskip("test_msgs.msg", reason="test_msgs is not installed")
    from rclpy.serialization import serialize_message

    message = messages.WStrings()
    message.wstring_value = text
    message.array_of_wstrings = [text, "b", ""]
    message.bounded_sequence_of_wstrings = [text]
    raw = serialize_message(message)
    register(
        "test_msgs/msg/WStrings",
        "wstring wstring_value\nwstring wstring_value_default1\nwstring wstring_value_default2\n"
        "wstring wstring_value_default3\nwstring[3] array_of_wstrings\n"
        "wstring[<=3] bounded_sequence_of_wstrings\nwstring[] unbounded_sequence_of_wstrings\n",
    )
    strings: Any = decode("test_msgs/msg/WStrings", raw)
    assert strings.wstring_value == text
    assert strings.wstring_value_default3 == "ハローワールド"
    assert list(strings.array_of_wstrings) == [text, "b", ""]
    assert list(strings.bounded_sequence_of_wstrings) == [text]
    ours = encode("test_msgs/msg/WStrings", strings)
    assert ours == raw[: len(ours)]  # which has room behind it


@pytest.mark.parametrize("count", [3, 1 << 20, 0xFFFFFFFF])
def test_a_wstring_longer_than_its_message_is_refused(count: int) -> None:
    with pytest.raises(DecodeError, match=f"a wide string of {count} characters is longer"):
        decode(NAME, b"\0\1\0\0" + b"\1\0\0\0" + struct.pack("<I", count) + b"a\0b\0"[:2])


def test_stamps_behind_a_wstring_are_found() -> None:
    register("wide_msgs/msg/Late", "wstring text\nstd_msgs/Header header\n")
    values = {"text": "ab", "header": {"stamp": {"sec": 7}}}
    cdr = shifted("wide_msgs/msg/Late", encode("wide_msgs/msg/Late", values), 10**9)
    late_message: Any = decode("wide_msgs/msg/Late", cdr)
    assert (late_message.text, late_message.header.stamp_ns) == ("ab", 8 * 10**9)


@pytest.mark.skipif(not REPORT.exists(), reason="../shared/data is absent")
def test_all_fields_of_a_public_report_are_read() -> None:
    recording = open_recording(REPORT)
    (channel,) = recording.channels
    register(channel.type, channel.definition)
    messages: list[Any] = [
        decode(channel.type, each.data) for each in recording.messages([channel], 0, 2**63)
    ]
    recording.close()
    assert len(messages) == 50
    assert {(each.w, each.short, each.ok, each.header.frame_id) for each in messages} == {
        ("gr\xfcn", "abc", True, "base_link")
    }
