"""Commands that pages send by name, and what refuses those that do not fit."""

from __future__ import annotations

from typing import Any

import pytest

from tests.page.conftest import Tab
from webviz import commands
from webviz.edges.access.rules import COMMANDS
from webviz.edges.page.acts import command_of


def test_a_command_has_the_types_of_its_fields() -> None:
    assert command_of("SetBackground", {"color": [1, 2, 3]}) == commands.SetBackground((1, 2, 3))
    command = command_of("AddDisplay", {"type": "Grid"}, made=print, deliver=print)
    assert command == commands.AddDisplay("Grid", made=print)


@pytest.mark.parametrize(
    ("name", "arguments", "reason"),
    [
        ("SetBackground", {"color": [1, 2, 300]}, "<= 255"),
        ("SetFrameRate", {"hz": "fast"}, "Expected `float`"),
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


def test_no_page_may_load_code() -> None:
    assert commands.ReloadPlugin not in COMMANDS


def test_the_page_that_asks_gets_the_answer(tab: Tab) -> None:
    ask = "async (hz) => (await import('/webviz/act.js')).act('SetFrameRate', {hz})"
    tab.page.evaluate(f"(hz) => {{ window.answer = ({ask})(hz) }}", 30)
    tab.wait_for_command(commands.SetFrameRate(30.0))
    assert tab.loop.senders[-1].browser is not None
    assert tab.page.evaluate("window.answer") == {"level": "ok", "text": "", "display": ""}
    tab.loop.answer = ValueError("Not changed: too fast.")
    tab.page.evaluate(f"(hz) => {{ window.answer = ({ask})(hz) }}", 1000)
    tab.wait_for(lambda: "Not changed: too fast." in tab.text())
