"""Untrusted messages over the channel of a page, against a whole viewer."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import webviz
from tests.support.guest import Guest, Served
from webviz.engine.forms import MAX_TEXT
from webviz.server.access import rules
from webviz.server.channel.channel import Channel

LONG = "x" * 40_000
ARGUMENTS: list[dict[str, Any]] = [
    {},
    {LONG: 1},
    {"display": LONG, "name": LONG, "frame": LONG, "tool": LONG, "path": LONG, "key": LONG},
    {"display": "display1", "path": "topic" + ".x" * 10_000, "value": 1},
    {"type": LONG, "values": {"name": LONG}},
    {"type": "Grid", "values": {"name": [[[1]]], "plane": 1e308}},
    {"steps": -5},
    {"steps": 2**64},
    {"hz": 1e-308},
    {"color": [2**64, 0, 0]},
    {"key": "focal_point", "value": [2**64] * 3},
    {"name": "a", "view": {"type": "Orbit"}},
    {"text": "[" * 100_000, "name": "a.yaml"},
    {"path": "\x00"},
]


@pytest.fixture
def guest(
    viewer: webviz.Viewer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Guest]:
    monkeypatch.chdir(tmp_path)  # for recordings that it starts
    viewer.config = {"displays": [{"type": "Grid"}]}
    guest = Guest(Served(viewer.port))
    yield guest
    guest.close()


def test_commands_that_make_no_sense_are_refused_in_one_short_sentence(
    guest: Guest, caplog: pytest.LogCaptureFixture
) -> None:
    for class_ in rules.commands():
        for arguments in ARGUMENTS:
            answer = guest.do(class_.__name__, **arguments)
            assert len(answer) <= 1000, class_
    assert "nested that deeply" in guest.do(
        "SetProperty", display=next(iter(ids(guest))), path="name" + ".x" * 1000, value=1
    )
    assert caplog.messages == []


def test_a_text_of_a_page_has_a_limit(guest: Guest, viewer: webviz.Viewer) -> None:
    (grid,) = ids(guest)
    answer = guest.do("SetProperty", display=grid, path="name", value="x" * (MAX_TEXT + 1))
    assert answer == f"Failed: expected at most {MAX_TEXT} characters."
    deep: Any = 1
    for _ in range(100):
        deep = [deep]
    answer = guest.do("AddDisplay", type="Grid", values={"name": deep})
    assert answer == "Failed: expected at most 64 nested levels."
    assert "at most" in guest.do("WriteDisplays", displays=[""] * 60_000)
    assert [display.name for display in viewer.displays] == ["Grid"]


def test_numbers_that_json_cannot_hold_reach_no_page(
    guest: Guest, viewer: webviz.Viewer, caplog: pytest.LogCaptureFixture
) -> None:
    guest.send(
        "CommandRequest", number=2**70, command="Undo", arguments={}
    )  # it could not be answered
    guest.do("AddDisplay", type="LaserScan", values={"topic": {"name": "/a", "depth": 2**64}})
    scan = ids(guest)[-1]
    guest.send("Watch", store=f"properties:{scan}")
    values = guest.receive("Values")["set"]
    assert (values["name"], values["value.topic.depth"]) == ("LaserScan", 2**64)
    assert [m for m in caplog.messages if "ignored" not in m] == []


def test_the_view_of_another_browser_is_not_sent(guest: Guest) -> None:
    own = guest.page["browser"]
    for store in (f"view:{own + 1}", f"view_type:{own + 1}", "view:", f"view_type:{own}"):
        guest.send("Watch", store=store)
    assert guest.receive("Values")["store"] == f"view_type:{own}"


def test_the_number_of_stores_a_page_watches_is_limited(
    guest: Guest, monkeypatch: pytest.MonkeyPatch
) -> None:
    for number in range(500):
        guest.send("Watch", store=f"properties:{number}")
    guest.send("Watch", store="x" * 100_000)
    guest.do("Undo")
    guest.send("Watch", store="history")
    guest.do("Undo")
    counts: list[int] = []
    watched = Channel.watched
    with monkeypatch.context() as patch:

        def noting(channel: Channel) -> set[str]:
            counts.append(len(watched(channel)))
            return watched(channel)

        patch.setattr(Channel, "watched", noting)
        guest.do("Undo")
    assert counts[-1] == max(counts) == 64


def ids(guest: Guest) -> list[str]:
    """The displays of the viewer."""
    guest.send("Watch", store="displays")
    order = guest.receive("Values")["set"]["order"]
    guest.send("Unwatch", store="displays")
    return order
