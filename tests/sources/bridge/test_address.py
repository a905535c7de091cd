"""Addresses of bridges and their headers."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from webviz.api.errors import Error
from webviz.sources.bridge.address import HEADERS, address


def test_credentials_are_in_no_sentence() -> None:
    bridge = address(
        "wss://user:secret@robot.example:9999/way/", environment={HEADERS: "T: secret"}
    )
    assert (bridge.name, bridge.place) == ("wss://robot.example:9999/way", "robot.example:9999")
    assert "secret" not in repr(bridge) + bridge.name + bridge.place
    assert bridge.headers == [("T", "secret")]


def test_places_have_the_port_of_the_scheme() -> None:
    assert address("ws://[::1]").place == "[::1]:80"
    assert address("wss://robot").place == "robot:443"


@pytest.mark.parametrize(
    "url",
    [
        "",
        "robot:8765",
        "http://robot:8765",
        "ws://",
        "ws://robot:99999",
        "ws://robot:0",
        "ws://[::1",
        "ws://a b",
        "ws://röbot",
        "ws://robot\n",
    ],
)
def test_invalid_addresses_are_refused(url: str) -> None:
    with pytest.raises(Error, match=r"is not the address of a bridge. Write ws://HOST:PORT"):
        address(url)


@pytest.mark.parametrize("line", ["no colon: but a space in: the name", "X: \x07", "é: x", ": x"])
def test_invalid_headers_are_refused_without_their_value(line: str) -> None:
    value = line.partition(":")[2]
    with pytest.raises(Error, match="is invalid") as excinfo:
        address("ws://robot", environment={HEADERS: f"A: b\n{line}"})
    assert not value or value not in str(excinfo.value)


def test_a_file_of_headers_is_a_small_file(tmp_path: Path) -> None:
    path = tmp_path / "headers"
    with pytest.raises(Error, match="is not a file"):
        address("ws://robot", path)
    os.mkfifo(path)
    with pytest.raises(Error, match="is not a file"):
        address("ws://robot", path)
    path.unlink()
    path.write_bytes(b"A: b\n" * 20_000)
    with pytest.raises(Error, match="larger than 64 kB"):
        address("ws://robot", path)
    path.write_bytes(b"A: b\n".ljust(64 << 10))
    assert address("ws://robot", path, {}).headers == [("A", "b")]
    path.write_text("A: b\n\nC-D:e f \n")
    assert address("ws://robot", path, {}).headers == [("A", "b"), ("C-D", "e f")]
