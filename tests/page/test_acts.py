"""Commands that pages send by name, and what refuses those that do not fit."""

from __future__ import annotations

import functools
from collections.abc import Iterator
from typing import Any

import pytest

from tests.page.tabs import ViewerTab
from webviz import commands
from webviz.page.dispatcher import command_of
from webviz.server.access import rules


def test_a_command_has_the_types_of_its_fields() -> None:
    assert command_of("SetBackground", {"color": [1, 2, 3]}) == commands.SetBackground((1, 2, 3))
    command = command_of("AddDisplay", {"type": "Grid"}, made=print, deliver=print)
    assert command == commands.AddDisplay("Grid", made=print)


@pytest.mark.parametrize(
    ("name", "arguments", "reason"),
    [
        ("SetBackground", {"color": [1, 2, 300]}, "<= 255"),
        ("SetFrameRate", {"hz": "fast"}, "Expected `float`"),
        ("FocusFrame", {"frame": [[]] * 60_000}, "Expected `str`"),
        ("SetFrameRate", {}, "missing required field `hz`"),
        ("SaveView", {"name": "a", "browser": 3}, "unknown field `browser`"),
        ("AddDisplay", {"type": "Grid", "made": "x"}, "unknown field `made`"),
        ("ReloadPlugin", {"path": "/etc/passwd"}, "Reload the page"),
        ("__class__", {}, "Reload the page"),
    ],
)
def test_what_does_not_fit_is_refused(name: str, arguments: dict[str, Any], reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        command_of(name, arguments)


class UnreadableList(list[None]):
    """An unreadable list."""

    def __iter__(self) -> Iterator[None]:
        pytest.fail("a list was read that is too long")


@pytest.mark.parametrize(
    ("value", "reason"),
    [
        (UnreadableList([None] * 50_001), "at most 50000 values"),
        (dict.fromkeys(map(str, range(25_001))), "at most 50000 values"),
        (100_001 * "x", "at most 100000 characters"),
        (functools.reduce(lambda value, _: [value], range(100), 0), "nested levels"),
    ],
    ids=["list", "dict", "text", "nested"],
)
def test_what_has_no_end_is_refused_before_it_is_read(value: object, reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        command_of("ChangeView", {"key": "type", "value": value})


def test_no_page_may_load_code() -> None:
    assert commands.ReloadPlugin not in rules.commands()


def test_the_page_that_asks_gets_the_answer(viewer_tab: ViewerTab) -> None:
    tab, viewer = viewer_tab, viewer_tab.viewer
    ask = "async (hz) => (await import('webviz/act.js')).act('SetFrameRate', {hz})"
    tab.page.evaluate(f"(hz) => {{ window.answer = ({ask})(hz) }}", 30)
    tab.wait_for_command(commands.SetFrameRate(30.0))
    assert viewer.senders[-1].browser == tab.browser
    assert viewer.settings.frame_rate == 30.0
    assert tab.page.evaluate("window.answer") == {"level": "ok", "text": ""}
    tab.page.evaluate(f"(hz) => {{ window.answer = ({ask})(hz) }}", 1000)
    tab.wait_for(lambda: "Not changed: frame_rate" in tab.text())
    assert viewer.settings.frame_rate == 30.0
