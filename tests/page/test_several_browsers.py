"""Several browsers share one viewer."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

from tests.page.conftest import Tab
from tests.page.properties_pane import Pane
from webviz.engine.state import Row
from webviz.scene.server import Server

MakeRow = Callable[..., Row]
OpenTab = Callable[[], Tab]


@pytest.fixture(scope="module")
def other_tab(open_lasting_tab: OpenTab) -> Tab:
    return open_lasting_tab()


@pytest.fixture
def mine(tab: Tab, make_row: MakeRow) -> Iterator[Pane]:
    tab.loop.show(make_row("a"))
    yield from mounted(tab)


@pytest.fixture
def other(mine: Pane, other_tab: Tab) -> Iterator[Pane]:
    yield from mounted(other_tab)


def mounted(tab: Tab) -> Iterator[Pane]:
    yield Pane(tab).mount()
    tab.page.evaluate("ended(); document.querySelector('#bench').remove()")


def test_two_who_edit_in_turns_see_the_same(mine: Pane, other: Pane) -> None:
    editor, watcher = mine, other
    for value in ("4", "15", "6", "17"):
        editor.enter("count", value)
        watcher.wait_for_value("count", value)
        editor, watcher = watcher, editor
    editor.field("filled").uncheck()
    watcher.tab.wait_for(lambda: not watcher.field("filled").is_checked())
    assert editor.field("count").input_value() == "17"


def test_two_who_edit_at_once_end_with_the_same(mine: Pane, other: Pane) -> None:
    mine.field("channel").fill("mine")
    other.enter("channel", "other")
    other.wait_for_set("channel", "other")
    assert mine.field("channel").input_value() == "mine"
    mine.keyboard.press("Enter")
    other.wait_for_value("channel", "mine")
    other.field("channel").fill("half")
    mine.enter("channel", "again")
    mine.wait_for_set("channel", "again")
    other.keyboard.press("Escape")
    other.wait_for_value("channel", "again")
    mine.wait_for_value("channel", "again")


def test_a_field_that_was_left_or_has_the_focus_shows_what_another_has_entered(
    mine: Pane, other: Pane
) -> None:
    mine.enter("count", "0")
    mine.tab.wait_for(mine.row("count").get_by_role("alert").is_visible)
    mine.field("channel").focus()
    other.enter("count", "7")
    mine.wait_for_value("count", "7")
    assert mine.row("count").get_by_role("alert").is_hidden()
    mine.field("count").focus()
    other.enter("count", "8")
    mine.wait_for_value("count", "8")


def test_a_browser_that_comes_late_sees_how_things_are(
    mine: Pane, open_tab: OpenTab, make_row: MakeRow
) -> None:
    mine.tab.loop.show(make_row("a", count=8, filled=False), fixed_frame="odom")
    mine.wait_for_value("count", "8")
    late = Pane(open_tab()).mount()
    late.wait_for_value("count", "8")
    assert not late.field("filled").is_checked()


def test_a_browser_that_was_cut_off_comes_back_to_how_things_are_now(
    mine: Pane, server: Server, make_row: MakeRow
) -> None:
    mine.field("count").fill("5")
    cut_off = mine.page.evaluate("webviz.browser")
    for connection in tuple(server._websock_server._live_connections.values()):
        server.get_event_loop().call_soon_threadsafe(connection.transport.abort)
    mine.tab.wait_for(lambda: mine.page.evaluate("webviz.browser") not in (None, cut_off))
    mine.tab.loop.show(make_row("a", count=9, channel="ring"))
    mine.wait_for_value("channel", "ring")
    assert mine.field("count").input_value() == "5"
    mine.keyboard.press("Escape")
    mine.wait_for_value("count", "9")
    mine.enter("count", "4")
    mine.wait_for_set("count", 4)
