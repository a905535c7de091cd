"""Displays are dragged to another place by mouse; test_phone.py does so by finger."""

from __future__ import annotations

import playwright.sync_api as playwright
import pytest
from pages import bounds

from tests.page.everything import group, named
from tests.page.page_bench import PageBench
from tests.page.tabs import ViewerTab
from tests.page.trees import Tree
from webviz.commands import MoveDisplay

BEFORE = "a g(b c) d empty() e"


@pytest.fixture
def tree(viewer: PageBench, viewer_tab: ViewerTab) -> Tree:
    """A group with two displays, and others around it."""
    full = group("g", *named("b", "c"))
    viewer.show(*named("a"), full, *named("d"), group("empty"), *named("e"))
    tree = Tree(viewer_tab)
    tree.wait_for_names("a", "g", "b", "c", "d", "empty", "e")
    return tree


def at(tree: Tree, name: str, share: float) -> tuple[float, float]:
    """A place on a row; `share` of its height."""
    tree.tab.wait_for(lambda: tree.row(name).bounding_box())
    box = bounds(tree.row(name))
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
    ("name", "to", "share", "dx", "after"),
    [
        ("e", "a", 0.2, 0, "e a g(b c) d empty()"),
        ("a", "e", 0.8, 0, "g(b c) d empty() e a"),
        ("e", "g", 0.5, 0, "a g(b c e) d empty()"),
        ("e", "empty", 0.5, 0, "a g(b c) d empty(e)"),
        ("e", "c", 0.2, 0, "a g(b e c) d empty()"),
        ("d", "c", 0.8, 20, "a g(b c d) empty() e"),
        ("b", "c", 0.8, -20, "a g(c) b d empty() e"),
        ("b", "c", 0.8, 0, "a g(c b) d empty() e"),
        ("a", "Global Options", 0.9, 0, BEFORE),
        ("g", "c", 0.5, 0, BEFORE),
        ("d", "d", 0.8, 0, BEFORE),
    ],
)
def test_a_display_goes_where_the_line_is(
    viewer: PageBench, tree: Tree, name: str, to: str, share: float, dx: float, after: str
) -> None:
    assert viewer.outline() == BEFORE
    drag(tree, name, to, share, dx)
    assert tree.tab.page.locator(".wv-tree-drop").is_visible()
    tree.tab.page.mouse.up()
    tree.tab.wait_for(lambda: viewer.outline() == after)
    tree.tab.turn()
    assert [type(command) for command in viewer.commands] == [MoveDisplay] * (after != BEFORE)
    assert not tree.tab.page.locator(".wv-tree-drop").is_visible()
    assert tree.selected() == [name]


def test_all_that_is_selected_goes_together_in_its_order(viewer: PageBench, tree: Tree) -> None:
    tree.click("d")
    tree.click("a", modifiers=["Control"])
    drag(tree, "d", "g", 0.5)
    assert "2 displays" in tree.tab.text()
    tree.tab.page.mouse.up()
    tree.tab.wait_for(lambda: len(viewer.commands) == 2)
    assert viewer.outline() == "g(b c a d) empty() e"
    assert tree.selected() == ["a", "d"]


def test_escape_cancels_a_drag(viewer: PageBench, tree: Tree) -> None:
    tree.click("a")
    drag(tree, "e", "g", 0.5)
    tree.tab.page.keyboard.press("Escape")
    assert not tree.tab.page.locator(".wv-tree-drop").is_visible()
    tree.tab.page.mouse.up()
    tree.tab.turn()
    assert viewer.commands == []
    assert tree.selected() == ["a"]


def test_a_folded_group_opens_under_what_is_held_over_it(viewer: PageBench, tree: Tree) -> None:
    tree.fold("g")
    tree.wait_for_names("a", "g", "d", "empty", "e")
    drag(tree, "e", "g", 0.5)
    tree.wait_for_names("a", "g", "b", "c", "d", "empty", "e")
    tree.tab.page.mouse.up()
    tree.tab.wait_for(lambda: viewer.outline() == "a g(b c e) d empty()")


def test_the_list_scrolls_at_its_edges(viewer: PageBench, tree: Tree) -> None:
    viewer.show(*named(*(f"row{i}" for i in range(40))))
    tree.tab.wait_for(lambda: "row5" in tree.names())
    drag(tree, "row1", "row5", 0.5)
    box = bounds(tree.tab.page.locator(".wv-tree"))
    tree.tab.page.mouse.move(100, box["y"] + box["height"] - 6)
    last = tree.tab.page.get_by_role("button", name="Add display", exact=False)
    tree.tab.wait_for(lambda: "row39" in tree.names())
    playwright.expect(last.last).to_be_in_viewport()
    tree.tab.page.mouse.move(100, at(tree, "row39", 0.8)[1])
    tree.tab.page.mouse.up()
    tree.tab.wait_for(lambda: viewer.outline().endswith("row39 row1"))
