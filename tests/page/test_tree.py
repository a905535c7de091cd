"""The tree of displays: what it shows, by mouse."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import playwright.sync_api as playwright
import pytest
from msgspec.structs import replace
from viser_internals import cut_connections

from tests.page.conftest import Loop, Tab
from tests.page.trees import Tree, group
from webviz.api.declared import Topic
from webviz.api.status import Level, OtherFixedFrame, Status
from webviz.commands import (
    AddDisplay,
    DuplicateDisplay,
    FocusDisplay,
    MoveDisplay,
    RemoveDisplay,
    ResetDisplay,
    SetFixedFrame,
    SetProperty,
    WriteDisplays,
)
from webviz.data.transforms.reasons import Explanation, Kind
from webviz.engine.state import Row, Traffic
from webviz.scene.server import Server
from webviz_displays.grid import Grid

MakeRow = Callable[..., Row]
LOST = {"Topic": Status(Level.ERROR, "No publisher on /scan. Start the laser driver.")}
FEW = {"Points": Status(Level.WARN, "No points.")}


@pytest.fixture
def tree(tab: Tab) -> Tree:
    return Tree(tab)


def test_rows_stand_in_order_below_the_global_options(
    loop: Loop, tree: Tree, make_row: MakeRow
) -> None:
    a, b, c = make_row("a"), make_row("b"), make_row("c", enabled=False)
    loop.show(a, b)
    tree.wait_for_names("a", "b")
    loop.show(c, b, a)
    tree.wait_for_names("c", "b", "a")
    assert [tree.box(name).is_checked() for name in "cba"] == [False, True, True]
    assert "map, 60 Hz" in tree.row("Global Options").inner_text()


def test_an_id_of_another_display_gets_its_icon(loop: Loop, tree: Tree, make_row: MakeRow) -> None:
    """As when a viewer starts again with another config under an open page."""
    icon = tree.row("a").locator(".wv-tree-type").first
    loop.show(make_row("a"))
    tree.wait_for_names("a")
    assert icon.get_attribute("data-icon") == "plug"
    loop.show(Row("a", "Grid", Grid(name="a"), "a", {}))
    tree.tab.wait_for(lambda: icon.get_attribute("data-tip") == "Grid")
    assert icon.get_attribute("data-icon") == "grid"
    assert icon.locator("svg").count() == 1


def test_an_empty_list_explains_itself_above_the_button_that_adds(
    loop: Loop, tree: Tree, make_row: MakeRow
) -> None:
    hint = tree.tab.page.get_by_text("No displays yet.")
    tree.tab.wait_for(hint.is_visible)
    above, below = hint.bounding_box(), tree.tab.button("Add display").bounding_box()
    assert above is not None
    assert below is not None
    assert 0 < below["y"] - above["y"] < 60
    loop.show(make_row("a"))
    tree.tab.wait_for(hint.is_hidden)


def test_a_problem_is_a_line_under_the_name_and_a_disabled_display_has_none(
    loop: Loop, tree: Tree, make_row: MakeRow
) -> None:
    loop.show(make_row("a", statuses=LOST), make_row("b", statuses=FEW), make_row("c"))
    tree.wait_for_names("a", "b", "c")
    text = LOST["Topic"].text
    assert tree.row("a").inner_text().split("\n") == ["a", text]
    assert tree.row("a").get_by_text(text).get_attribute("data-tip") == text
    levels = [tree.row(name).get_attribute("data-level") for name in "abc"]
    assert levels == ["error", "warn", "ok"]
    loop.show(make_row("a", statuses=LOST, enabled=False))
    tree.tab.wait_for(lambda: tree.row("a").inner_text() == "a")
    assert tree.row("a").get_attribute("data-level") is None


def test_one_cause_stands_on_top_with_a_button_that_solves_it(
    loop: Loop, tree: Tree, make_row: MakeRow
) -> None:
    text = "Fixed frame does not exist."
    reason = Explanation(Kind.UNKNOWN_FIXED_FRAME, text)
    cause = Status(Level.ERROR, text, OtherFixedFrame("odom"), reason=reason)
    names = ("Map", "Scan", "Robot")
    loop.show(
        *(
            make_row(name, statuses={"Transform": dataclasses.replace(cause, remedy=None)})
            for name in names
        ),
        statuses={"Fixed Frame": cause},
    )
    tree.tab.wait_for(lambda: tree.tab.text().count(cause.text) == 1)
    tree.row("Global Options").get_by_role("button", name="Use odom").click()
    tree.tab.wait_for_command(SetFixedFrame("odom"))
    assert tree.selected() == []
    loop.show(*map(make_row, names), statuses={})
    tree.tab.wait_for(lambda: tree.tab.button("Use odom").count() == 0)


def test_a_long_line_takes_two_lines_and_the_others_move(
    loop: Loop, tree: Tree, make_row: MakeRow
) -> None:
    loop.show(make_row("a"), make_row("b"))
    tree.wait_for_names("a", "b")

    def below() -> float:
        return tree.top("b") - tree.top("a")

    tree.tab.wait_for(lambda: below() < 30)
    before = below()
    loop.show(make_row("a", statuses={"x": Status(Level.WARN, "word " * 200)}), make_row("b"))
    tree.tab.wait_for(lambda: before + 30 < below() < before + 45)


def test_a_check_box_enables_its_display_and_shows_what_the_viewer_says(
    loop: Loop, tree: Tree, make_row: MakeRow
) -> None:
    loop.show(make_row("a"), make_row("b"))
    tree.box("b").uncheck()
    tree.tab.wait_for_command(SetProperty("b", "enabled", False))
    tree.tab.wait_for(lambda: tree.row("b").get_attribute("data-off") is not None)
    assert tree.row("a").get_attribute("data-off") is None
    loop.show(make_row("a"), make_row("b"))
    tree.tab.wait_for(lambda: tree.box("b").is_checked())


def test_what_is_refused_is_set_back(loop: Loop, tree: Tree, make_row: MakeRow) -> None:
    loop.show(group("g"), replace(make_row("a"), display=None))
    tree.wait_for_names("g", "a")
    assert tree.box("a").is_disabled()
    loop.answer = ValueError("Not changed: no.")
    tree.box("g").click()
    loop.turn()
    tree.tab.wait_for(lambda: "Not changed: no." in tree.tab.text())


def test_a_click_selects_and_ctrl_and_shift_select_several(
    loop: Loop, tree: Tree, make_row: MakeRow
) -> None:
    loop.show(*(make_row(name) for name in "abcde"))
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
    assert loop.commands == []


def test_groups_fold_and_a_folded_one_says_what_is_wrong_inside(
    loop: Loop, tree: Tree, make_row: MakeRow
) -> None:
    inner = replace(make_row("a", statuses=LOST), depth=1)
    loop.show(group("g", statuses={"a": LOST["Topic"]}), inner, make_row("b"))
    tree.wait_for_names("g", "a", "b")
    assert tree.row("g").inner_text() == "g"
    tree.fold("g")
    tree.wait_for_names("g", "b")
    assert tree.row("g").inner_text() == f"g\na: {LOST['Topic'].text}"
    assert tree.row("g").get_attribute("aria-expanded") == "false"
    tree.fold("g")
    tree.wait_for_names("g", "a", "b")


def test_a_display_unfolds_its_properties_below_it(
    loop: Loop, tree: Tree, make_row: MakeRow
) -> None:
    loop.show(make_row("a"), make_row("b"))
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
    loop: Loop, tree: Tree, make_row: MakeRow
) -> None:
    loop.show(make_row("a", statuses=LOST), make_row("b"))
    tree.click("a")
    details = tree.details
    tree.tab.wait_for(lambda: LOST["Topic"].text in details.inner_text())
    tree.tab.button("Close properties").click()
    tree.click("b")
    assert not details.is_visible()
    tree.tab.button("List options").click()
    tree.tab.page.get_by_text("Properties below the tree").click()
    assert details.get_by_role("heading").inner_text() == "b"
    loop.show(make_row("a"))
    tree.tab.wait_for(lambda: not details.is_visible())


def test_a_double_click_renames_and_escape_does_not(
    loop: Loop, tree: Tree, make_row: MakeRow
) -> None:
    loop.show(make_row("a"), make_row("b"))
    field = tree.tab.page.get_by_label("Name", exact=True)
    tree.row("a").dblclick()
    field.fill("Front laser")
    field.press("Enter")
    tree.tab.wait_for_command(SetProperty("a", "name", "Front laser"))
    assert field.count() == 0
    loop.commands.clear()
    tree.row("b").dblclick()
    field.fill("other")
    field.press("Escape")
    tree.tab.turn()
    assert field.count() == 0
    assert loop.commands == []
    assert tree.row("b").evaluate("row => row === document.activeElement")


def test_somebody_who_renames_is_not_disturbed_by_what_others_do(
    loop: Loop, tree: Tree, make_row: MakeRow
) -> None:
    loop.show(make_row("a"), make_row("b"))
    field = tree.tab.page.get_by_label("Name", exact=True)
    tree.row("b").dblclick()
    field.fill("lab")
    loop.show(make_row("new"), make_row("b", statuses=LOST), make_row("a"))
    tree.tab.wait_for(lambda: tree.names()[-1] == "a")
    field.press_sequentially(" 2")
    field.press("Enter")
    tree.tab.wait_for_command(SetProperty("b", "name", "lab 2"))


@pytest.mark.parametrize(
    ("label", "command"),
    [
        ("Focus", FocusDisplay),
        ("Duplicate", DuplicateDisplay),
        ("Reset to defaults", ResetDisplay),
        ("Remove", RemoveDisplay),
    ],
)
def test_the_menu_does_what_it_says(
    loop: Loop, tree: Tree, make_row: MakeRow, label: str, command: type[Any]
) -> None:
    loop.show(make_row("a"), make_row("b"))
    tree.row("b").click(button="right")
    tree.item(label).click()
    tree.tab.wait_for(lambda: loop.commands)
    done: Any = loop.commands[-1]
    assert len(loop.commands) == 1
    assert isinstance(done, command)
    assert done.display == "b"


def test_the_button_of_a_row_opens_its_menu_which_renames(
    loop: Loop, tree: Tree, make_row: MakeRow
) -> None:
    loop.show(make_row("a"), make_row("b"))
    tree.row("b").hover()
    tree.tab.button("Actions for b").click()
    assert tree.selected() == ["b"]
    tree.item("Rename").click()
    tree.tab.page.get_by_label("Name", exact=True).fill("c")
    tree.click("a")
    tree.tab.wait_for_command(SetProperty("b", "name", "c"))


def test_several_are_copied_as_yaml(loop: Loop, tree: Tree, make_row: MakeRow) -> None:
    tree.tab.page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    loop.show(make_row("a"), make_row("b"), make_row("c"))
    tree.click("a")
    tree.click("b", modifiers=["Control"])
    loop.answer = "- {type: Grid}\n"
    tree.row("b").click(button="right")
    tree.item("Copy as YAML").click()
    tree.tab.wait_for_command(WriteDisplays(("a", "b")))
    tree.tab.wait_for(lambda: "Copied 2 displays as YAML." in tree.tab.text())
    assert tree.tab.page.evaluate("navigator.clipboard.readText()") == loop.answer


def test_several_are_put_into_a_new_group(loop: Loop, tree: Tree, make_row: MakeRow) -> None:
    loop.show(make_row("a"), make_row("b"), make_row("c"), make_row("d"))
    loop.made = "g"
    tree.click("b")
    tree.click("c", modifiers=["Shift"])
    tree.row("c").click(button="right")
    tree.item("Put into a new group").click()
    tree.tab.wait_for(lambda: len(loop.commands) == 4)
    add, *moves = loop.commands
    assert isinstance(add, AddDisplay)
    assert (add.type, add.group) == ("Group", "")
    assert moves == [MoveDisplay("b", "g"), MoveDisplay("c", "g"), MoveDisplay("g", "", "d")]
    assert len({sender.step for sender in loop.senders} - {0}) == 1
    inner = [replace(make_row(name), depth=1) for name in "bc"]
    loop.show(make_row("a"), group("g"), *inner, make_row("d"))
    tree.tab.page.get_by_label("Name", exact=True).wait_for()
    assert tree.selected() == ["g"]


def test_an_added_display_is_selected_and_scrolled_into_view(
    loop: Loop, tree: Tree, make_row: MakeRow
) -> None:
    rows = [make_row(f"row{i}") for i in range(60)]
    loop.show(*rows)
    tree.click("row1")
    loop.made = "new"
    tree.row("row1").click(button="right")
    tree.item("Duplicate").click()
    tree.tab.wait_for(lambda: loop.commands)
    loop.show(*rows, make_row("new"))
    tree.tab.wait_for(lambda: tree.selected() == ["new"])
    playwright.expect(tree.row("new")).to_be_in_viewport()


def test_the_search_ends_when_something_else_is_added(
    loop: Loop, tree: Tree, make_row: MakeRow
) -> None:
    loop.show(make_row("a"), make_row("b"))
    field = tree.tab.page.get_by_label("Filter displays")
    field.fill("b")
    tree.wait_for_names("b")
    tree.row("b").click(button="right")
    loop.made = "new"
    tree.item("Duplicate").click()
    tree.tab.wait_for(lambda: loop.commands)
    loop.show(make_row("a"), make_row("b"), make_row("new"))
    tree.wait_for_names("a", "b", "new")
    assert field.input_value() == ""


def test_the_search_finds_by_name_type_and_topic(loop: Loop, tree: Tree, make_row: MakeRow) -> None:
    scan = replace(make_row("scan", topic=Topic("/front/laser")), depth=1)
    loop.show(group("Sensors"), scan, replace(make_row("Cloud"), depth=1), make_row("Map"))
    tree.wait_for_names("Sensors", "scan", "Cloud", "Map")
    field = tree.tab.page.get_by_label("Filter displays")
    tree.fold("Sensors")
    for text, found in (
        ("LASER", ["Sensors", "scan"]),
        ("group", ["Sensors", "scan", "Cloud"]),
        ("cloud every", ["Sensors", "Cloud"]),
        ("nothing", []),
    ):
        field.fill(text)
        tree.wait_for_names(*found)
    assert "No matching displays." in tree.tab.text()
    field.press("Escape")
    tree.wait_for_names("Sensors", "Map")
    tree.fold("Sensors")


def test_ctrl_f_searches_while_the_pointer_is_in_the_side(
    loop: Loop, tree: Tree, make_row: MakeRow
) -> None:
    loop.show(make_row("a"))
    field = tree.tab.page.get_by_label("Filter displays")
    tree.row("a").hover()
    tree.tab.page.keyboard.press("Control+f")
    assert field.evaluate("field => field === document.activeElement")


def test_the_rate_is_read_at_the_selected_row_only(
    loop: Loop, tree: Tree, make_row: MakeRow
) -> None:
    loop.show(make_row("a"), make_row("b"), traffic={"/scan": Traffic(39.84, 1.0)})
    tree.click("a")
    tree.tab.page.mouse.move(800, 400)
    tree.tab.wait_for(lambda: [tree.row(each).inner_text() for each in "ab"] == ["a\n40 Hz", "b"])


def test_untrusted_names_are_shown_as_text_on_one_line(
    loop: Loop, tree: Tree, make_row: MakeRow
) -> None:
    names = {
        "<img src=x onerror=alert(1)>": "<img src=x onerror=alert(1)>",
        "a\u202egnp.\u2066b": "a gnp. b",
        "two\nlines\x00\x1b": "two lines",
        "half \ud800 pair": "half   pair",
        "ש" * 30: "ש" * 30,
        "x" * 10_000: "x" * 299 + "…",
    }
    status = {"<b>": Status(Level.ERROR, "<script>alert(2)</script>\n\u202e")}
    loop.show(*(make_row(f"r{i}", name=name, statuses=status) for i, name in enumerate(names)))
    tree.tab.wait_for(lambda: len(tree.names()) == len(names))
    shown = [name.strip() for name in tree.names()]
    assert shown == list(names.values())
    heads = tree.tab.page.locator(".wv-tree-canvas .wv-tree-head").all()
    boxes = [head.bounding_box() for head in heads]
    assert {box["height"] for box in boxes if box} == {26}
    assert tree.tab.page.locator(".wv-tree-canvas img, .wv-tree-canvas script").count() == 0


def test_nothing_in_the_page_changes_while_nothing_changes(
    loop: Loop, tree: Tree, make_row: MakeRow
) -> None:
    loop.show(group("g", statuses=LOST), *(make_row(name, statuses=LOST) for name in "abc"))
    tree.click("a")
    tree.tab.page.evaluate(
        "() => { window.changes = 0;"
        "new MutationObserver((all) => (window.changes += all.length)).observe("
        "document.querySelector('.wv-side'), "
        "{subtree: true, childList: true, attributes: true, characterData: true}); }"
    )

    def changes() -> int:
        """In some turns; what the click has begun may take a while on a busy machine."""
        tree.tab.page.evaluate("window.changes = 0")
        for _ in range(20):
            tree.tab.turn()
        return tree.tab.page.evaluate("window.changes")

    assert any(changes() == 0 for _ in range(10))


def test_five_hundred_displays_are_a_few_rows_in_the_page(
    loop: Loop, tree: Tree, make_row: MakeRow
) -> None:
    rows = [make_row(f"row{i}", statuses=LOST if i % 3 else {}) for i in range(500)]
    loop.show(*rows)
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
    loop.show(*rows[:-1])
    tree.tab.wait_for(lambda: "row499" not in tree.names())
    assert tree.names()[-1] == "row498"


def cut_off(tab: Tab, server: Server) -> None:
    """End the connections of all pages, and wait until the page has a new one."""
    before = set(server.get_clients())
    cut_connections(server)
    tab.wait_for(lambda: server.get_clients() and not before & set(server.get_clients()))


def test_after_a_lost_connection_names_say_what_was_selected_and_folded(
    server: Server,
    loop: Loop,
    tree: Tree,
    make_row: MakeRow,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    loop.show(group("g"), replace(make_row("a"), depth=1), make_row("b"))
    tree.fold("g")
    tree.click("b")
    page = tree.tab.page
    # A page that is back before the change would see that displays have other names.
    page.evaluate("""() => {
      window.KeptWebSocket = WebSocket;
      window.WebSocket = class {
        static OPEN = 1;
        readyState = 0;
        constructor() { window.isKeptOut = true; }
        close() {}
      };
    }""")
    cut_off(tree.tab, server)
    tree.tab.wait_for(lambda: page.evaluate("window.isKeptOut"))
    rows = (
        make_row("b", name="new"),
        group("g"),
        replace(make_row("x", name="a"), depth=1),
    )
    loop.show(*rows, make_row("a", name="b"))
    page.evaluate("() => { window.WebSocket = window.KeptWebSocket; }")
    # The settings come first: the page must not take the displays of before for those of now.
    watched = server.channel.watched
    monkeypatch.setattr(server.channel, "watched", lambda: watched() - {"displays"})
    cut_off(tree.tab, server)
    tree.tab.wait_for(lambda: "settings" in watched())
    for _ in range(5):
        tree.tab.turn()
    monkeypatch.undo()
    tree.wait_for_names("new", "g", "b")
    assert tree.selected() == ["b"]
    tree.fold("g")


def test_cards_and_properties_leave_rows_in_sight(
    loop: Loop, open_tab: Callable[..., Tab], make_row: MakeRow
) -> None:
    tab = open_tab(height=400)
    loop.show(make_row("a", "A"))
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
