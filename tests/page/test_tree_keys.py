"""The tree of displays by keyboard."""

from __future__ import annotations

import playwright.sync_api as playwright
import pytest

from tests.page.everything import group, named
from tests.page.page_bench import PageBench
from tests.page.tabs import ViewerTab
from tests.page.trees import Tree
from webviz.commands import MoveDisplay, Redo, RemoveDisplay, SetProperty, Undo

BEFORE = "a g(b c) camera"


@pytest.fixture
def tree(viewer: PageBench, viewer_tab: ViewerTab) -> Tree:
    """A group with two displays between two others; the first of all is selected."""
    viewer.show(*named("a"), group("g", *named("b", "c")), *named("camera"))
    tree = Tree(viewer_tab)
    tree.wait_for_names("a", "g", "b", "c", "camera")
    tree.click("a")
    viewer_tab.page.mouse.move(10, 10)
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


def test_space_switches_all_that_is_selected(viewer: PageBench, tree: Tree) -> None:
    tree.click("camera")
    tree.press("Shift+ArrowUp")
    tree.press(" ")
    tree.tab.wait_for(lambda: len(viewer.commands) == 2)
    assert [row.name for row in viewer.rows if not row.enabled] == ["c", "camera"]


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
    ("start", "keys", "after"),
    [
        ("camera", "Alt+ArrowUp", "a camera g(b c)"),
        ("a", "Alt+ArrowDown", "g(b c) a camera"),
        ("g", "Alt+ArrowDown", "a camera g(b c)"),
        ("b", "Alt+ArrowDown", "a g(c b) camera"),
        ("b", "Alt+ArrowLeft", "a g(c) b camera"),
        ("camera", "Alt+ArrowRight", "a g(b c camera)"),
        ("a", "Alt+ArrowUp", BEFORE),
        ("b", "Alt+ArrowUp", BEFORE),
        ("c", "Alt+ArrowDown", BEFORE),
        ("a", "Alt+ArrowLeft", BEFORE),
        ("a", "Alt+ArrowRight", BEFORE),
    ],
)
def test_alt_and_arrows_move(
    viewer: PageBench, tree: Tree, start: str, keys: str, after: str
) -> None:
    tree.click(start)
    assert viewer.outline() == BEFORE
    tree.press(keys)
    tree.tab.wait_for(lambda: viewer.outline() == after)
    tree.tab.turn()
    assert [type(command) for command in viewer.commands] == [MoveDisplay] * (after != BEFORE)
    assert tree.selected() == [start]


def test_several_keep_their_order_when_they_are_moved(viewer: PageBench, tree: Tree) -> None:
    tree.click("c")
    tree.press("Shift+ArrowUp")
    tree.press("Alt+ArrowLeft")
    tree.tab.wait_for(lambda: len(viewer.commands) == 2)
    assert viewer.outline() == "a g() b c camera"


def test_delete_removes_and_the_next_one_is_selected(viewer: PageBench, tree: Tree) -> None:
    tree.click("g")
    tree.press("Delete")
    tree.tab.wait_for(lambda: tree.selected() == ["camera"])
    assert viewer.outline() == "a camera"
    assert focused(tree) == "camera"
    camera = viewer.id("camera")
    tree.press("Delete")
    tree.tab.wait_for_command(RemoveDisplay(camera))
    tree.tab.wait_for(lambda: tree.selected() == ["a"])
    viewer.do(Undo())
    tree.tab.wait_for(lambda: tree.selected() == ["camera"])
    assert focused(tree) == "camera"
    viewer.do(Redo())
    tree.tab.wait_for(lambda: tree.names() == ["a"])
    tree.click("a")
    viewer.do(Undo())
    tree.tab.wait_for(lambda: tree.names() == ["a", "camera"])
    assert tree.selected() == ["a"], "it was selected meanwhile"


def test_f2_renames_and_keys_in_the_field_are_not_for_the_tree(
    viewer: PageBench, tree: Tree
) -> None:
    a = viewer.id("a")
    tree.press("F2")
    tree.tab.page.keyboard.type("c ")
    tree.press("Home")
    tree.press("Delete")
    tree.press("Enter")
    tree.tab.wait_for(lambda: viewer.commands)
    assert viewer.commands == [SetProperty(a, "name", "")]
    assert viewer.outline() == "Everything g(b c) camera"


def test_shift_f10_opens_the_menu_and_escape_comes_back(tree: Tree) -> None:
    tree.press("Shift+F10")
    playwright.expect(tree.item("Focus")).to_be_focused()
    tree.press("Escape")
    assert focused(tree) == "a"
    assert tree.item("Focus").count() == 0
