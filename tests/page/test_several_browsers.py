"""Several browsers share one viewer."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

import playwright.sync_api as playwright
import pytest
from msgspec.structs import replace
from viser_internals import cut_connections

from tests.page.conftest import Tab
from tests.page.properties_pane import Pane
from tests.page.test_plugin_panels import Frames, open_panel, tabs
from tests.page.trees import Tree, group
from webviz.api import registry
from webviz.api.status import Level, Status
from webviz.api.views import FPS, TopDownOrtho
from webviz.commands import InspectTopics, SaveImage, UseTool
from webviz.engine.commands import Sender
from webviz.engine.state import Inspected, Row
from webviz.features.tools.toolbar import ToolButton
from webviz.features.undo import HistoryStep, UndoHistory
from webviz.scene.server import Server
from webviz.sources import Offer, Publisher

MakeRow = Callable[..., Row]


@pytest.fixture(scope="module")
def other_tab(open_lasting_tab: Callable[[], Tab]) -> Tab:
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
    unmount(tab)


def unmount(tab: Tab) -> None:
    tab.page.evaluate("ended(); document.querySelector('#bench').remove()")


def test_a_browser_that_comes_late_sees_how_things_are_and_asks_for_itself(
    mine: Pane, make_row: MakeRow, request: pytest.FixtureRequest
) -> None:
    """The first test of this module, since the other browser is then the late one."""
    request.addfinalizer(partial(registry.register, "tests", {}))
    open_panel(mine.tab.loop, mine.tab, Frames)
    steps = UndoHistory((HistoryStep(3001, "Move Path", 10**6),))
    row = make_row("a", count=8, filled=False)
    mine.tab.loop.show(row, history=steps, frames=("late_frame",))
    mine.wait_for_value("count", "8")
    tab: Tab = request.getfixturevalue("other_tab")
    late = Pane(tab).mount()
    late.wait_for_value("count", "8")
    assert not late.field("filled").is_checked()
    tab.wait_for(lambda: not tab.button("Undo").is_disabled())
    assert "in another browser" not in tab.text(), "of old steps"
    tab.wait_for(lambda: "Frames" in tabs(tab))
    tab.show_tab("Frames")
    tab.wait_for(lambda: "late_frame" in tab.text())
    for each in (tab, mine.tab):
        each.show_tab("Displays")
    tab.page.keyboard.press("Control+k")
    tab.page.get_by_role("dialog", name="Commands").get_by_role("combobox").fill("save image")
    tab.page.keyboard.press("Enter")
    tab.wait_for_command(SaveImage())
    asking, watching = (each.page.evaluate("webviz.browser") for each in (late, mine))
    assert tab.loop.senders[-1] == Sender(asking)
    assert asking != watching
    unmount(tab)


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


def test_two_who_select_and_fold_do_so_for_themselves(
    tab: Tab, other_tab: Tab, make_row: MakeRow
) -> None:
    tree, other = Tree(tab), Tree(other_tab)
    tab.loop.show(group("g"), replace(make_row("a"), depth=1), make_row("b"))
    tree.wait_for_names("g", "a", "b")
    other.wait_for_names("g", "a", "b")
    tree.click("b")
    other.click("a")
    other.fold("g")
    other.wait_for_names("g", "b")
    assert tree.names() == ["g", "a", "b"]
    assert tree.selected() == ["b"]
    tab.loop.show(group("g"), replace(make_row("a"), depth=1), make_row("b", name="renamed"))
    tree.wait_for_names("g", "a", "renamed")
    assert tree.selected() == ["renamed"]
    tab.loop.show(group("g"))
    tree.wait_for_names("g")
    assert tree.selected() == []


def test_two_who_look_have_views_of_their_own_with_their_numbers(tab: Tab, other_tab: Tab) -> None:
    mine, yours = (each.page.evaluate("webviz.browser") for each in (tab, other_tab))
    tab.loop.show(views={mine: TopDownOrtho(scale=62.3), yours: FPS(yaw=1.25)})
    for each, seen, unseen, path, value in (
        (tab, "Scale", "Position", "scale", "62.3"),
        (other_tab, "Position", "Scale", "yaw", "1.25"),
    ):
        each.show_tab("Views")
        panel = each.page.locator("#wv-panel")
        each.wait_for(lambda text=panel.inner_text, seen=seen: seen in text())
        assert unseen not in panel.inner_text()
        assert panel.locator(f"[data-path='{path}'] input").input_value() == value
        each.show_tab("Displays")


def test_a_browser_that_was_cut_off_comes_back_to_how_things_are_now(
    mine: Pane, server: Server, make_row: MakeRow
) -> None:
    mine.field("count").fill("5")
    cut_off = mine.page.evaluate("webviz.browser")
    cut_connections(server)
    mine.tab.wait_for(lambda: mine.page.evaluate("webviz.browser") not in (None, cut_off))
    mine.tab.loop.show(make_row("a", count=9, channel="ring"))
    mine.wait_for_value("channel", "ring")
    assert mine.field("count").input_value() == "5"
    mine.keyboard.press("Escape")
    mine.wait_for_value("count", "9")
    mine.enter("count", "4")
    mine.wait_for_set("count", 4)


def test_two_who_use_tools_select_them_and_are_answered_for_themselves(
    tab: Tab, other_tab: Tab
) -> None:
    tab.loop.show(tools=(ToolButton("goal", "Goal", "Sends a goal.", "g", "pose"),))
    for each in (tab, other_tab):
        each.wait_for(lambda each=each: each.button("Goal").is_visible())
    tab.button("Goal").click()
    playwright.expect(tab.button("Goal")).to_have_attribute("aria-pressed", "true")
    playwright.expect(other_tab.button("Goal")).to_have_attribute("aria-pressed", "false")
    tab.page.mouse.move(600, 500)
    tab.page.mouse.down()
    tab.page.mouse.move(640, 500)
    tab.page.mouse.up()
    tab.wait_for(lambda: [type(each) for each in tab.loop.commands] == [UseTool])
    (used,) = tab.loop.commands
    assert isinstance(used, UseTool)
    used.report(Status(Level.OK, "Published."))
    tab.wait_for(lambda: tab.page.locator(".wv-hint").inner_text() == "Published.")
    assert other_tab.page.locator(".wv-hint").inner_text() == ""


def test_two_who_look_into_topics_choose_for_themselves_until_one_leaves(
    tab: Tab, other_tab: Tab
) -> None:
    """The last test of this module, since the other one is gone then."""
    publisher = Publisher("/driver", "std_msgs/msg/String", "reliable", "volatile")
    tab.loop.show(offers=dict.fromkeys(("/scan", "/map"), Offer((publisher,))))
    for each, topic in ((other_tab, "/map"), (tab, "/scan")):
        each.show_tab("Topics")
        each.page.locator(".wv-cell-name").get_by_text(topic, exact=True).click()
    tab.wait_for_command(InspectTopics(frozenset({"/scan", "/map"})))
    result = {"/scan": {"mine": "1"}, "/map": {"yours": "2"}}
    tab.loop.show(
        inspected={name: Inspected("x", {"fields": each}) for name, each in result.items()}
    )
    tab.wait_for(lambda: "mine" in tab.text())
    other_tab.wait_for(lambda: "yours" in other_tab.text())
    assert "yours" not in tab.text()
    other_tab.page.close()
    tab.wait_for_command(InspectTopics(frozenset({"/scan"})))
    tab.page.locator(".wv-inspected").get_by_role("button", name="Close").click()
    tab.wait_for_command(InspectTopics(frozenset()))
