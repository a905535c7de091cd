"""The tree of displays: what it shows, by mouse."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import playwright.sync_api as playwright
import pytest
import yaml
from pages import bounds

from tests.page.everything import Everything, group, named
from tests.page.page_bench import SCAN, PageBench
from tests.page.tabs import ViewerTab
from tests.page.trees import Tree
from webviz.api.declared import Topic
from webviz.api.status import Level, Status
from webviz.commands import (
    AddDisplay,
    DuplicateDisplay,
    FocusDisplay,
    MoveDisplay,
    RemoveDisplay,
    ResetDisplay,
    SetFixedFrame,
    SetProperty,
    Undo,
)
from webviz.files.config import Unreadable
from webviz.shell.testing.messages import header

NO_LASER = {"Laser": Status(Level.ERROR, "The laser is lost. Start its driver.")}
FEW = {"Points": Status(Level.WARN, "No points.")}


class StubbornEverything(Everything):
    """A display that cannot be disabled."""

    def __post_init__(self) -> None:
        if not self.enabled:
            raise ValueError("it stays on")


@pytest.fixture
def tree(viewer_tab: ViewerTab) -> Tree:
    return Tree(viewer_tab)


def test_rows_stand_in_order_below_the_global_options(viewer: PageBench, tree: Tree) -> None:
    viewer.show(*named("a", "b"))
    tree.wait_for_names("a", "b")
    viewer.show(Everything(name="c", enabled=False), *named("b", "a"))
    tree.wait_for_names("c", "b", "a")
    assert [tree.box(name).is_checked() for name in "cba"] == [False, True, True]
    assert "map, 60 Hz" in tree.row("Global Options").inner_text()


def test_an_empty_list_explains_itself_above_the_button_that_adds(
    viewer: PageBench, tree: Tree
) -> None:
    hint = tree.tab.page.get_by_text("No displays yet.")
    tree.tab.wait_for(hint.is_visible)
    above, below = bounds(hint), bounds(tree.tab.button("Add display"))
    assert 0 < below["y"] - above["y"] < 60
    viewer.show(*named("a"))
    tree.tab.wait_for(hint.is_hidden)


def test_a_problem_is_a_line_under_the_name_and_a_disabled_display_has_none(
    viewer: PageBench, tree: Tree
) -> None:
    viewer.report(a=NO_LASER, b=FEW)
    viewer.show(*named("a", "b", "c"))
    tree.wait_for_names("a", "b", "c")
    text = NO_LASER["Laser"].text
    tree.tab.wait_for(lambda: tree.row("a").inner_text().split("\n") == ["a", text])
    assert tree.row("a").get_by_text(text).get_attribute("data-tip") == text
    levels = [tree.row(name).get_attribute("data-level") for name in "abc"]
    assert levels == ["error", "warn", "ok"]
    viewer.do(SetProperty(viewer.id("a"), "enabled", False))
    tree.tab.wait_for(lambda: tree.row("a").inner_text() == "a")
    assert tree.row("a").get_attribute("data-level") is None


def test_one_cause_stands_on_top_with_a_button_that_solves_it(
    viewer: PageBench, tree: Tree
) -> None:
    scans = [Everything(name=name, topic=Topic("/front")) for name in ("Map", "Scan", "Robot")]
    viewer.show(*scans, fixed_frame="earth")
    viewer.publish("/front", SCAN, {"header": header("base_link", viewer.source.now)})
    viewer.turn()
    viewer.pass_time(1.1)  # it has waited long enough, but the doctor has not looked twice
    cause = 'Fixed frame "earth" does not exist. Use "map", the root of the largest tree'
    tree.tab.wait_for(lambda: tree.row("Scan").get_attribute("data-level") == "error")
    assert [row.statuses["Transform"].text.startswith(cause) for row in viewer.rows] == [True] * 3
    assert tree.tab.text().count(cause) == 1
    tree.row("Global Options").get_by_role("button", name="Use map").click()
    tree.tab.wait_for_command(SetFixedFrame("map"))
    assert tree.selected() == []
    tree.tab.wait_for(lambda: tree.tab.button("Use map").count() == 0)
    tree.tab.wait_for(lambda: tree.row("Scan").get_attribute("data-level") == "ok")
    assert cause not in tree.tab.text()


def test_a_long_line_takes_two_lines_and_the_others_move(viewer: PageBench, tree: Tree) -> None:
    viewer.show(*named("a", "b"))
    tree.wait_for_names("a", "b")

    def below() -> float:
        return tree.top("b") - tree.top("a")

    tree.tab.wait_for(lambda: below() < 30)
    before = below()
    viewer.report(a={"x": Status(Level.WARN, "word " * 200)})
    tree.tab.wait_for(lambda: before + 30 < below() < before + 45)


def test_a_check_box_enables_its_display_and_shows_what_the_viewer_says(
    viewer: PageBench, tree: Tree
) -> None:
    viewer.show(*named("a", "b"))
    b = viewer.id("b")
    tree.box("b").uncheck()
    tree.tab.wait_for_command(SetProperty(b, "enabled", False))
    assert [row.enabled for row in viewer.rows] == [True, False]
    tree.tab.wait_for(lambda: tree.row("b").get_attribute("data-off") is not None)
    assert tree.row("a").get_attribute("data-off") is None
    viewer.do(SetProperty(b, "enabled", True))
    tree.tab.wait_for(lambda: tree.box("b").is_checked())


def test_what_is_refused_is_set_back(viewer: PageBench, tree: Tree) -> None:
    unreadable = Unreadable({"type": "Grd", "name": "a"}, "displays[1]: unknown type `Grd`.")
    viewer.show(StubbornEverything(name="g"), unreadable)
    tree.wait_for_names("g", "a")
    assert tree.box("a").is_disabled()
    tree.box("g").click()
    tree.tab.wait_for(lambda: "Not changed: " in tree.tab.text() and viewer.commands)
    assert "it stays on" in tree.tab.text()
    playwright.expect(tree.box("g")).to_be_checked()


def test_a_click_selects_and_ctrl_and_shift_select_several(viewer: PageBench, tree: Tree) -> None:
    viewer.show(*named(*"abcde"))
    tree.wait_for_names(*"abcde")
    assert tree.selected() == []
    tree.click("b")
    assert tree.selected() == ["b"]
    tree.click("d", modifiers=["Control"])
    assert tree.selected() == ["b", "d"]
    tree.click("b", modifiers=["Control"])
    assert tree.selected() == ["d"]
    tree.click("d", modifiers=["Shift"])
    assert tree.selected() == ["b", "c", "d"]
    tree.click("a")
    assert tree.selected() == ["a"]
    assert viewer.commands == []


def test_groups_fold_and_a_folded_one_says_what_is_wrong_inside(
    viewer: PageBench, tree: Tree
) -> None:
    viewer.report(a=NO_LASER)
    viewer.show(group("g", *named("a")), *named("b"))
    tree.wait_for_names("g", "a", "b")
    tree.tab.wait_for(lambda: NO_LASER["Laser"].text in tree.row("a").inner_text())
    assert tree.row("g").inner_text() == "g"
    tree.fold("g")
    tree.wait_for_names("g", "b")
    assert tree.row("g").inner_text() == f"g\na: {NO_LASER['Laser'].text}"
    assert tree.row("g").get_attribute("aria-expanded") == "false"
    tree.fold("g")
    tree.wait_for_names("g", "a", "b")


def test_a_display_unfolds_its_properties_below_it(viewer: PageBench, tree: Tree) -> None:
    viewer.show(*named("a", "b"))
    tree.wait_for_names("a", "b")
    inside = tree.tab.page.get_by_role("group", name="Properties of a")
    tree.fold("a")
    inside.wait_for()
    tree.tab.wait_for(lambda: tree.top("b") - tree.top("a") > 60)
    tree.click("a")
    assert not tree.details.is_visible(), "properties stand once"
    tree.fold("a")
    tree.tab.wait_for(tree.details.is_visible)
    tree.tab.wait_for(lambda: tree.top("b") - tree.top("a") < 30 and inside.count() == 0)


def test_the_selected_display_is_shown_below_until_that_is_closed(
    viewer: PageBench, tree: Tree
) -> None:
    viewer.report(a=NO_LASER)
    viewer.show(*named("a", "b"))
    tree.click("a")
    details = tree.details
    tree.tab.wait_for(lambda: NO_LASER["Laser"].text in details.inner_text())
    tree.tab.button("Close properties").click()
    tree.click("b")
    assert not details.is_visible()
    tree.tab.button("List options").click()
    tree.tab.page.get_by_text("Properties below the tree").click()
    assert details.get_by_role("heading").inner_text() == "b"
    viewer.do(RemoveDisplay(viewer.id("b")))
    tree.tab.wait_for(lambda: not details.is_visible())


def test_a_double_click_renames_and_escape_does_not(viewer: PageBench, tree: Tree) -> None:
    viewer.show(*named("a", "b"))
    a = viewer.id("a")
    field = tree.tab.page.get_by_label("Name", exact=True)
    tree.row("a").dblclick()
    field.fill("Front laser")
    field.press("Enter")
    tree.tab.wait_for_command(SetProperty(a, "name", "Front laser"))
    assert viewer.outline() == "Front laser b"
    assert field.count() == 0
    tree.wait_for_names("Front laser", "b")
    viewer.forget_commands()
    tree.row("b").dblclick()
    field.fill("other")
    field.press("Escape")
    tree.tab.turn()
    assert field.count() == 0
    assert viewer.commands == []
    assert tree.row("b").evaluate("row => row === document.activeElement")


def test_somebody_who_renames_is_not_disturbed_by_what_others_do(
    viewer: PageBench, tree: Tree
) -> None:
    viewer.show(*named("a", "b"))
    a, b = viewer.id("a"), viewer.id("b")
    field = tree.tab.page.get_by_label("Name", exact=True)
    tree.row("b").dblclick()
    field.fill("lab")
    viewer.report(b=NO_LASER)
    viewer.do(AddDisplay("Grid", {"name": "new"}))
    viewer.do(MoveDisplay(viewer.id("new"), "", a))
    viewer.do(MoveDisplay(a))
    tree.tab.wait_for(lambda: tree.names()[-1] == "a")
    field.press_sequentially(" 2")
    field.press("Enter")
    tree.tab.wait_for_command(SetProperty(b, "name", "lab 2"))
    assert viewer.outline() == "new lab 2 a"


@pytest.mark.parametrize(
    ("label", "command", "after"),
    [
        ("Focus", FocusDisplay, "a b"),
        ("Duplicate", DuplicateDisplay, "a b b 2"),
        ("Reset to defaults", ResetDisplay, "a b"),
        ("Remove", RemoveDisplay, "a"),
    ],
)
def test_the_menu_does_what_it_says(
    viewer: PageBench, tree: Tree, label: str, command: type[Any], after: str
) -> None:
    viewer.show(*named("a"), Everything(name="b", count=8))
    b = viewer.id("b")
    tree.row("b").click(button="right")
    tree.item(label).click()
    tree.tab.wait_for(lambda: viewer.commands)
    done: Any = viewer.commands[-1]
    assert len(viewer.commands) == 1
    assert isinstance(done, command)
    assert done.display == b
    assert viewer.outline() == after
    counts = {"Remove": [3], "Reset to defaults": [3, 3], "Duplicate": [3, 8, 8]}
    assert viewer.values("count") == counts.get(label, [3, 8])


def test_the_button_of_a_row_opens_its_menu_which_renames(viewer: PageBench, tree: Tree) -> None:
    viewer.show(*named("a", "b"))
    tree.row("b").hover()
    tree.tab.button("Actions for b").click()
    assert tree.selected() == ["b"]
    tree.item("Rename").click()
    tree.tab.page.get_by_label("Name", exact=True).fill("c")
    tree.click("a")
    tree.tab.wait_for(lambda: viewer.outline() == "a c")
    assert len(viewer.commands) == 1


def test_several_are_copied_as_yaml(viewer: PageBench, tree: Tree) -> None:
    tree.tab.page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    viewer.show(*named("a", "b", "c"))
    tree.click("a")
    tree.click("b", modifiers=["Control"])
    tree.row("b").click(button="right")
    tree.item("Copy as YAML").click()
    tree.tab.wait_for(lambda: "Copied 2 displays as YAML." in tree.tab.text())
    copied = yaml.safe_load(tree.tab.page.evaluate("navigator.clipboard.readText()"))
    assert [(each["type"], each["name"]) for each in copied] == [
        ("Everything", "a"),
        ("Everything", "b"),
    ]


def test_several_are_put_into_a_new_group(viewer: PageBench, tree: Tree) -> None:
    viewer.show(*named("a", "b", "c", "d"))
    tree.click("b")
    tree.click("c", modifiers=["Shift"])
    tree.row("c").click(button="right")
    tree.item("Put into a new group").click()
    tree.tab.wait_for(lambda: len(viewer.commands) == 4)
    assert viewer.outline() == "a Group(b c) d"
    assert len({sender.step for sender in viewer.senders} - {0}) == 1
    assert viewer.history().undo[0].label == "Add Group"
    tree.tab.page.get_by_label("Name", exact=True).wait_for()
    assert tree.selected() == ["Group"]
    viewer.do(Undo())
    assert viewer.outline() == "a b c d"


def test_an_added_display_is_selected_and_scrolled_into_view(viewer: PageBench, tree: Tree) -> None:
    viewer.show(*named(*(f"row{i}" for i in range(60))))
    tree.click("row1")
    tree.press("End")
    tree.tab.wait_for(lambda: tree.selected() == ["row59"])
    bottom = tree.row("row59").bounding_box()
    tree.row("row59").click(button="right")
    tree.item("Duplicate").click()
    tree.tab.wait_for(lambda: tree.selected() == ["row59 2"])
    playwright.expect(tree.row("row59 2")).to_be_in_viewport()
    assert tree.row("row59 2").bounding_box() == bottom, "the list was scrolled"


def test_the_search_ends_when_something_else_is_added(viewer: PageBench, tree: Tree) -> None:
    viewer.show(*named("a", "b"))
    field = tree.tab.page.get_by_label("Filter displays")
    field.fill("b")
    tree.wait_for_names("b")
    tree.tab.button("Add display").click()
    dialog = tree.tab.page.get_by_role("dialog")
    dialog.get_by_role("tab", name="By display").click()
    tree.tab.page.keyboard.type("axes of one frame")
    tree.tab.wait_for(lambda: dialog.get_by_role("option").count() == 1)
    tree.tab.page.keyboard.press("Enter")
    tree.wait_for_names("a", "b", "Axes")
    assert field.input_value() == ""


def test_the_search_finds_by_name_type_and_topic(viewer: PageBench, tree: Tree) -> None:
    scan = Everything(name="scan", topic=Topic("/front/laser"))
    viewer.show(group("Sensors", scan, *named("Cloud")), *named("Map"))
    tree.wait_for_names("Sensors", "scan", "Cloud", "Map")
    field = tree.tab.page.get_by_label("Filter displays")
    tree.fold("Sensors")
    for text, expected in (
        ("LASER", ["Sensors", "scan"]),
        ("group", ["Sensors", "scan", "Cloud"]),
        ("cloud every", ["Sensors", "Cloud"]),
        ("nothing", []),
    ):
        field.fill(text)
        tree.wait_for_names(*expected)
    assert "No matching displays." in tree.tab.text()
    field.press("Escape")
    tree.wait_for_names("Sensors", "Map")
    tree.fold("Sensors")


def test_ctrl_f_searches_while_the_pointer_is_in_the_side(viewer: PageBench, tree: Tree) -> None:
    viewer.show(*named("a"))
    field = tree.tab.page.get_by_label("Filter displays")
    tree.row("a").hover()
    tree.tab.page.keyboard.press("Control+f")
    assert field.evaluate("field => field === document.activeElement")


def test_the_rate_is_read_at_the_selected_row_only(viewer: PageBench, tree: Tree) -> None:
    viewer.show(*(Everything(name=name, topic=Topic("/front")) for name in "ab"))
    viewer.stream_scans("/front", 40.0)
    tree.click("a")
    tree.tab.page.mouse.move(800, 400)
    tree.tab.wait_for(lambda: [tree.row(each).inner_text() for each in "ab"] == ["a\n40 Hz", "b"])


def test_untrusted_names_are_shown_as_text_on_one_line(viewer: PageBench, tree: Tree) -> None:
    names = {
        "<img src=x onerror=alert(1)>": "<img src=x onerror=alert(1)>",
        "a\u202egnp.\u2066b": "a gnp. b",
        "two\nlines\x00\x1b": "two lines",
        "half \ud800 pair": "half   pair",
        "ש" * 30: "ש" * 30,
        "x" * 10_000: "x" * 299 + "…",
    }
    status = {"<b>": Status(Level.ERROR, "<script>alert(2)</script>\n\u202e")}
    viewer.report(**dict.fromkeys(names, status))
    viewer.show(*named(*names))
    tree.tab.wait_for(lambda: len(tree.names()) == len(names))
    texts = [name.strip() for name in tree.names()]
    assert texts == list(names.values())
    heads = tree.tab.page.locator(".wv-tree-canvas .wv-tree-head").all()
    boxes = [head.bounding_box() for head in heads]
    assert {box["height"] for box in boxes if box} == {26}
    assert tree.tab.page.locator(".wv-tree-canvas img, .wv-tree-canvas script").count() == 0


def test_nothing_in_the_page_changes_while_nothing_changes(viewer: PageBench, tree: Tree) -> None:
    viewer.report(a=NO_LASER, b=NO_LASER, c=NO_LASER)
    viewer.show(group("g"), *named("a", "b", "c"))
    tree.click("a")
    tree.tab.page.evaluate(
        "() => { window.changes = 0;"
        "new MutationObserver((all) => (window.changes += all.length)).observe("
        "document.querySelector('.wv-side'), "
        "{subtree: true, childList: true, attributes: true, characterData: true}); }"
    )

    def changes() -> int:
        """Return the changes in twenty turns: the click takes effect late on a busy machine."""
        tree.tab.page.evaluate("window.changes = 0")
        for _ in range(20):
            tree.tab.turn()
        return tree.tab.page.evaluate("window.changes")

    assert any(changes() == 0 for _ in range(10))


def test_five_hundred_displays_are_a_few_rows_in_the_page(viewer: PageBench, tree: Tree) -> None:
    names = [f"row{i}" for i in range(500)]
    viewer.report(**{name: NO_LASER for i, name in enumerate(names) if i % 3})
    viewer.show(*named(*names))
    tree.tab.wait_for(lambda: len(tree.names()) > 10)
    assert len(tree.names()) < 60
    tree.click("row2")

    def is_far_down() -> bool:
        tree.tab.page.mouse.wheel(0, 1000)
        return int(tree.names()[-1].removeprefix("row")) > 60

    tree.tab.wait_for(is_far_down)
    assert "row2" in tree.names(), "the row that keys are about stays"
    tree.tab.page.keyboard.press("End")
    tree.tab.wait_for(lambda: tree.selected() == ["row499"])
    playwright.expect(tree.row("row499")).to_be_in_viewport()
    assert len(tree.names()) < 60
    viewer.do(RemoveDisplay(viewer.id("row499")))
    tree.tab.wait_for(lambda: "row499" not in tree.names())
    assert tree.names()[-1] == "row498"


def test_cards_and_properties_leave_rows_in_sight(
    viewer: PageBench, open_viewer_tab: Callable[..., ViewerTab]
) -> None:
    tab = open_viewer_tab(height=400)
    viewer.show(*named("A"))
    tab.page.get_by_role("treeitem", name="Global Options", exact=True).click()
    tab.page.get_by_role("region", name="Properties", exact=True).wait_for()
    tab.page.evaluate(
        """() => {
          const card = document.createElement("div");
          card.style = "flex: none; height: 120px";
          document.querySelector(".wv-tree").before(card);
        }"""
    )
    tab.page.get_by_role("treeitem", name="A", exact=True).click(timeout=5000)
