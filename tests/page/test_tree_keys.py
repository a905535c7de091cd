"""The tree of displays by keyboard."""

from __future__ import annotations

from collections.abc import Callable

import playwright.sync_api as playwright
import pytest
from msgspec.structs import replace

from tests.page.conftest import Loop, Tab
from tests.page.trees import Tree, group
from webviz.commands import MoveDisplay, RemoveDisplay, SetProperty
from webviz.engine.commands import Command
from webviz.engine.state import Row

MakeRow = Callable[..., Row]


@pytest.fixture
def tree(tab: Tab, make_row: MakeRow) -> Tree:
    """A group with two displays between two others; the first of all is selected."""
    inner = [replace(make_row(name), depth=1) for name in ("b", "c")]
    tab.loop.show(make_row("a"), group("g"), *inner, make_row("camera"))
    tree = Tree(tab)
    tree.wait_for_names("a", "g", "b", "c", "camera")
    tree.click("a")
    tab.page.mouse.move(10, 10)
    return tree


def focused(tree: Tree) -> str | None:
    return tree.tab.page.evaluate("document.activeElement.getAttribute('aria-label')")


def test_arrows_home_and_end_select_and_shift_extends(tree: Tree) -> None:
    for keys, selected in (
        ("ArrowDown", ["g"]),
        ("Shift+ArrowDown", ["g", "b"]),
        ("Shift+End", ["g", "b", "c", "camera"]),
        ("ArrowUp", ["c"]),
        ("Home", ["Global Options"]),
        ("End", ["camera"]),
        ("Control+a", ["a", "g", "b", "c", "camera"]),
    ):
        tree.press(keys)
        assert tree.selected() == selected, keys
    tree.press("ArrowUp")
    tree.press("Control+ArrowUp")
    assert (focused(tree), tree.selected()) == ("b", ["c"])
    tree.press("Control+ ")
    assert tree.selected() == ["b", "c"]


def test_left_and_right_fold_and_go_in_and_out(tree: Tree) -> None:
    for keys, selected, names in (
        ("ArrowDown", "g", "agbc"),
        ("ArrowRight", "b", "agbc"),
        ("ArrowLeft", "g", "agbc"),
        ("ArrowLeft", "g", "ag"),
        ("ArrowRight", "g", "agbc"),
    ):
        tree.press(keys)
        assert (tree.selected(), "".join(tree.names()[:-1])) == ([selected], names), keys


def test_one_row_is_a_tab_stop_and_says_where_it_is(tree: Tree) -> None:
    tree.press("End")
    tree.press("ArrowUp")
    stops = tree.tab.page.locator(".wv-tree [tabindex='0']")
    assert stops.count() == 1
    names = ("aria-label", "aria-level", "aria-posinset", "aria-setsize", "aria-checked")
    assert [stops.get_attribute(name) for name in names] == ["c", "2", "2", "2", "true"]
    assert tree.row("camera").get_attribute("aria-posinset") == "4"


def test_space_switches_all_that_is_selected(loop: Loop, tree: Tree) -> None:
    tree.click("camera")
    tree.press("Shift+ArrowUp")
    tree.press(" ")
    tree.tab.wait_for(lambda: len(loop.commands) == 2)
    expected = [SetProperty(id_, "enabled", False) for id_ in ("c", "camera")]
    assert loop.commands in (expected, expected[::-1])


def test_letters_are_for_tools_after_a_click_on_the_tree(tree: Tree) -> None:
    tree.press("n")
    measure = tree.tab.page.get_by_role("toolbar").get_by_role("button", name="Measure")
    tree.tab.wait_for(lambda: measure.get_attribute("aria-pressed") == "true")
    tree.press("Escape")
    tree.press("?")
    keys = tree.tab.page.get_by_role("dialog")
    keys.wait_for()
    for each in ("Show or hide displays", "Copy as YAML", "Move in the list", "Drive"):
        assert keys.get_by_text(each, exact=True).count() == 1
    tree.press("Escape")


@pytest.mark.parametrize(
    ("start", "keys", "command"),
    [
        ("camera", "Alt+ArrowUp", MoveDisplay("camera", "", "g")),
        ("a", "Alt+ArrowDown", MoveDisplay("a", "", "camera")),
        ("g", "Alt+ArrowDown", MoveDisplay("g", "", "")),
        ("b", "Alt+ArrowDown", MoveDisplay("b", "g", "")),
        ("b", "Alt+ArrowLeft", MoveDisplay("b", "", "camera")),
        ("camera", "Alt+ArrowRight", MoveDisplay("camera", "g", "")),
        ("a", "Alt+ArrowUp", None),
        ("b", "Alt+ArrowUp", None),
        ("c", "Alt+ArrowDown", None),
        ("a", "Alt+ArrowLeft", None),
        ("a", "Alt+ArrowRight", None),
    ],
)
def test_alt_and_arrows_move(
    loop: Loop, tree: Tree, start: str, keys: str, command: Command | None
) -> None:
    tree.click(start)
    tree.press(keys)
    if command:
        tree.tab.wait_for_command(command)
    tree.tab.turn()
    assert loop.commands == ([command] if command else [])


def test_several_keep_their_order_when_they_are_moved(loop: Loop, tree: Tree) -> None:
    tree.click("c")
    tree.press("Shift+ArrowUp")
    tree.press("Alt+ArrowLeft")
    tree.tab.wait_for(lambda: len(loop.commands) == 2)
    assert loop.commands == [MoveDisplay("b", "", "camera"), MoveDisplay("c", "", "camera")]


def test_delete_removes_and_the_next_one_is_selected(
    loop: Loop, tree: Tree, make_row: MakeRow
) -> None:
    tree.click("g")
    tree.press("Delete")
    tree.tab.wait_for_command(RemoveDisplay("g"))
    loop.show(make_row("a"), make_row("camera"))
    tree.tab.wait_for(lambda: tree.selected() == ["camera"])
    assert focused(tree) == "camera"
    tree.press("Delete")
    tree.tab.wait_for_command(RemoveDisplay("camera"))
    loop.show(make_row("a"))
    tree.tab.wait_for(lambda: tree.selected() == ["a"])
    loop.show(make_row("a"), make_row("camera"))  # undone
    tree.tab.wait_for(lambda: tree.selected() == ["camera"])
    assert focused(tree) == "camera"
    loop.show(make_row("a"))  # redone
    tree.tab.wait_for(lambda: tree.names() == ["a"])
    tree.click("a")
    loop.show(make_row("a"), make_row("camera"))
    tree.tab.wait_for(lambda: tree.names() == ["a", "camera"])
    assert tree.selected() == ["a"], "it was selected meanwhile"


def test_f2_renames_and_keys_in_the_field_are_not_for_the_tree(loop: Loop, tree: Tree) -> None:
    tree.press("F2")
    tree.tab.page.keyboard.type("c ")
    tree.press("Home")
    tree.press("Delete")
    tree.press("Enter")
    tree.tab.wait_for_command(SetProperty("a", "name", ""))
    assert len(loop.commands) == 1


def test_shift_f10_opens_the_menu_and_escape_comes_back(tree: Tree) -> None:
    tree.press("Shift+F10")
    playwright.expect(tree.item("Focus")).to_be_focused()
    tree.press("Escape")
    assert focused(tree) == "a"
    assert tree.item("Focus").count() == 0
