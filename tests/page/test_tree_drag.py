"""Displays are dragged to another place by mouse; test_phone.py does so by finger."""

from __future__ import annotations

from collections.abc import Callable

import playwright.sync_api as playwright
import pytest
from msgspec.structs import replace

from tests.page.conftest import Loop, Tab
from tests.page.trees import Tree, group
from webviz.commands import MoveDisplay
from webviz.engine.commands import Command
from webviz.engine.state import Row

MakeRow = Callable[..., Row]


@pytest.fixture
def rows(make_row: MakeRow) -> list[Row]:
    """A group with two displays, and others around it."""
    inner = [replace(make_row(name), depth=1) for name in ("b", "c")]
    return [make_row("a"), group("g"), *inner, make_row("d"), group("empty"), make_row("e")]


@pytest.fixture
def tree(tab: Tab, rows: list[Row]) -> Tree:
    tab.loop.show(*rows)
    tree = Tree(tab)
    tree.wait_for_names("a", "g", "b", "c", "d", "empty", "e")
    return tree


def at(tree: Tree, name: str, share: float) -> tuple[float, float]:
    """A place on a row; `share` of its height."""
    tree.tab.wait_for(lambda: tree.row(name).bounding_box())
    box = tree.row(name).bounding_box()
    assert box is not None
    return box["x"] + 90, box["y"] + share * box["height"]


def drag(tree: Tree, name: str, to: str, share: float, dx: float = 0.0) -> None:
    """Take a row by its middle to a place on another one, and hold it there."""
    mouse = tree.tab.page.mouse
    mouse.move(*at(tree, name, 0.5))
    mouse.down()
    x, y = at(tree, to, share)
    mouse.move(x, y + 8)
    mouse.move(x + dx, y)


@pytest.mark.parametrize(
    ("name", "to", "share", "dx", "command"),
    [
        ("e", "a", 0.2, 0, MoveDisplay("e", "", "a")),
        ("a", "e", 0.8, 0, MoveDisplay("a", "", "")),
        ("e", "g", 0.5, 0, MoveDisplay("e", "g", "")),
        ("e", "empty", 0.5, 0, MoveDisplay("e", "empty", "")),
        ("e", "c", 0.2, 0, MoveDisplay("e", "g", "c")),
        ("d", "c", 0.8, 20, MoveDisplay("d", "g", "")),
        ("b", "c", 0.8, -20, MoveDisplay("b", "", "d")),
        ("b", "c", 0.8, 0, MoveDisplay("b", "g", "")),
        ("a", "Global Options", 0.9, 0, None),
        ("g", "c", 0.5, 0, None),
        ("d", "d", 0.8, 0, None),
    ],
)
def test_a_display_goes_where_the_line_is(
    loop: Loop, tree: Tree, name: str, to: str, share: float, dx: float, command: Command | None
) -> None:
    drag(tree, name, to, share, dx)
    assert tree.tab.page.locator(".wv-tree-drop").is_visible()
    tree.tab.page.mouse.up()
    if command:
        tree.tab.wait_for_command(command)
    tree.tab.turn()
    assert loop.commands == ([command] if command else [])
    assert not tree.tab.page.locator(".wv-tree-drop").is_visible()
    assert tree.selected() == [name]


def test_all_that_is_selected_goes_together_in_its_order(loop: Loop, tree: Tree) -> None:
    tree.click("d")
    tree.click("a", modifiers=["Control"])
    drag(tree, "d", "g", 0.5)
    assert "2 displays" in tree.tab.text()
    tree.tab.page.mouse.up()
    tree.tab.wait_for(lambda: len(loop.commands) == 2)
    assert loop.commands == [MoveDisplay("a", "g", ""), MoveDisplay("d", "g", "")]
    assert tree.selected() == ["a", "d"]


def test_escape_cancels_a_drag(loop: Loop, tree: Tree) -> None:
    tree.click("a")
    drag(tree, "e", "g", 0.5)
    tree.tab.page.keyboard.press("Escape")
    assert not tree.tab.page.locator(".wv-tree-drop").is_visible()
    tree.tab.page.mouse.up()
    tree.tab.turn()
    assert loop.commands == []
    assert tree.selected() == ["a"]


def test_a_folded_group_opens_under_what_is_held_over_it(loop: Loop, tree: Tree) -> None:
    tree.fold("g")
    tree.wait_for_names("a", "g", "d", "empty", "e")
    drag(tree, "e", "g", 0.5)
    tree.wait_for_names("a", "g", "b", "c", "d", "empty", "e")
    tree.tab.page.mouse.up()
    tree.tab.wait_for_command(MoveDisplay("e", "g", ""))


def test_the_list_scrolls_at_its_edges(loop: Loop, tree: Tree, make_row: MakeRow) -> None:
    loop.show(*(make_row(f"row{i}") for i in range(40)))
    tree.tab.wait_for(lambda: "row5" in tree.names())
    drag(tree, "row1", "row5", 0.5)
    box = tree.tab.page.locator(".wv-tree").bounding_box()
    assert box is not None
    tree.tab.page.mouse.move(100, box["y"] + box["height"] - 6)
    last = tree.tab.page.get_by_role("button", name="Add display", exact=False)
    tree.tab.wait_for(lambda: "row39" in tree.names())
    playwright.expect(last.last).to_be_in_viewport()
    tree.tab.page.mouse.move(100, at(tree, "row39", 0.8)[1])
    tree.tab.page.mouse.up()
    tree.tab.wait_for_command(MoveDisplay("row1", "", ""))
