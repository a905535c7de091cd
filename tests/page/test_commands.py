"""The list of commands, keys, and undo and redo."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import playwright.sync_api as playwright
import pytest
from viser_internals import cut_connections

from tests.page.everything import named
from tests.page.page_bench import PageBench
from tests.page.tabs import ViewerTab
from webviz.api.views import Orbit
from webviz.commands import (
    AddDisplay,
    ChangeView,
    FocusDisplay,
    FocusFrame,
    Redo,
    RemoveDisplay,
    Reset,
    ResetView,
    Save,
    SaveImage,
    SetFixedFrame,
    ShowView,
    Undo,
)
from webviz.engine.commands import Command, Sender
from webviz_displays.grid import Grid


def open_list(tab: ViewerTab) -> playwright.Locator:
    tab.page.keyboard.press("Control+k")
    return tab.page.get_by_role("dialog", name="Commands")


def run(tab: ViewerTab, words: str) -> None:
    """Do what the list finds by these words."""
    open_list(tab).get_by_role("combobox").fill(words)
    tab.page.keyboard.press("Enter")


def test_the_list_follows_a_frame_and_puts_it_into_the_middle(
    viewer: PageBench, viewer_tab: ViewerTab
) -> None:
    tab = viewer_tab
    viewer.link("map", "odom")
    open_list(tab)
    tab.wait_for(lambda: "Follow odom" in tab.text())
    tab.page.get_by_role("dialog").get_by_role("combobox").fill("follow odom")
    tab.page.keyboard.press("Enter")
    tab.wait_for(lambda: len(viewer.commands) == 2)
    assert viewer.commands == [ChangeView("target_frame", "odom"), FocusFrame("odom")]
    assert viewer.view(tab.browser).target_frame == "odom"


def test_the_list_finds_what_keys_do_in_the_tree(viewer: PageBench, viewer_tab: ViewerTab) -> None:
    tab = viewer_tab
    viewer.show(*named("a"))
    tab.page.get_by_role("treeitem", name="a", exact=True).click()
    tab.page.mouse.move(800, 400)
    for name in ("Rename display", "Remove display", "Filter displays"):
        dialog = open_list(tab)
        dialog.get_by_role("combobox").fill(name)
        dialog.get_by_role("option", name=name).wait_for()
        tab.page.keyboard.press("Escape")
    a = viewer.id("a")
    run(tab, "remove display")
    tab.wait_for_command(RemoveDisplay(a))
    assert viewer.outline() == ""


@pytest.mark.parametrize(
    ("words", "command"),
    [
        ("reset", Reset()),
        ("image", SaveImage()),
        ("topdown", ChangeView("type", "TopDownOrtho")),
        ("odom", SetFixedFrame("odom")),
        ("view kitchen", ShowView("kitchen")),
    ],
)
def test_the_list_finds_commands_frames_and_views_by_their_words(
    viewer: PageBench, viewer_tab: ViewerTab, words: str, command: Command
) -> None:
    tab = viewer_tab
    viewer.link("map", "odom")
    viewer.show(views={"kitchen": Orbit()})
    open_list(tab)
    tab.wait_for(lambda: "Fixed frame: odom" in tab.text())
    tab.page.get_by_role("dialog").get_by_role("combobox").fill(words)
    tab.page.keyboard.press("Enter")
    tab.wait_for_command(command)


def test_arrow_keys_choose_in_the_list_while_the_field_has_the_focus(viewer_tab: ViewerTab) -> None:
    dialog = open_list(viewer_tab)
    dialog.get_by_role("combobox").fill("theme")
    viewer_tab.page.keyboard.press("ArrowDown")
    playwright.expect(dialog.get_by_role("option", selected=True)).to_have_text("Theme: light")
    playwright.expect(dialog.get_by_role("combobox")).to_be_focused()
    viewer_tab.page.keyboard.press("Escape")


def test_every_command_of_the_list_has_an_icon(viewer_tab: ViewerTab) -> None:
    dialog = open_list(viewer_tab)
    dialog.get_by_role("option").first.wait_for()
    without = dialog.get_by_role("option").filter(has_not=viewer_tab.page.locator("svg"))
    assert without.count() == 0
    viewer_tab.page.keyboard.press("Escape")


def test_the_list_opens_once_and_visers_does_not(viewer_tab: ViewerTab) -> None:
    open_list(viewer_tab)
    viewer_tab.page.keyboard.press("Control+k")
    viewer_tab.turn()
    assert viewer_tab.page.get_by_role("dialog").count() == 1
    viewer_tab.page.keyboard.press("Escape")
    assert viewer_tab.page.locator(".mantine-Spotlight-root").count() == 0


@pytest.mark.parametrize(
    ("keys", "command"), [("Control+s", Save()), ("r", Reset()), ("z", ResetView())]
)
def test_keys_do_what_rviz_does(
    viewer: PageBench, viewer_tab: ViewerTab, tmp_path: Path, keys: str, command: Command
) -> None:
    file = tmp_path / "lab.yaml"
    viewer.show(*named("a"), path=file)
    viewer_tab.wait_for(lambda: "lab.yaml" in viewer_tab.text())
    viewer_tab.page.keyboard.press(keys)
    viewer_tab.wait_for_command(command)
    assert file.exists() == (keys == "Control+s")


def test_the_dialog_of_keys_has_those_of_commands_and_of_parts(viewer_tab: ViewerTab) -> None:
    viewer_tab.page.keyboard.press("?")
    dialog = viewer_tab.page.get_by_role("dialog", name="Keyboard and mouse")
    for group, does, keys in (
        ("File", "Save", "Ctrl+S"),
        ("Tree of displays", "Move in the list", "Alt+↑Alt+↓"),
        ("Image", "Zoom", "Wheel+-"),
        ("Plot", "Move in time", "←→"),
        ("While driving", "Drive", "WASD"),
        ("Scene", "Look at what is under the mouse", "F"),
    ):
        section = dialog.locator("section").filter(
            has=viewer_tab.page.get_by_role("heading", name=group)
        )
        row = (
            section.locator("dl > div")
            .filter(has=viewer_tab.page.locator("dt", has_text=does))
            .first
        )
        assert row.locator("dd").inner_text().replace("\n", "") == keys
    viewer_tab.page.keyboard.press("Escape")


@pytest.mark.parametrize(
    ("keys", "title"),
    [
        ("Control+o", "Open"),
        ("Control+Shift+s", "Save as"),
        ("Insert", "Add display"),
        ("?", "Keyboard and mouse"),
    ],
)
def test_keys_open_dialogs(viewer_tab: ViewerTab, keys: str, title: str) -> None:
    viewer_tab.page.keyboard.press(keys)
    playwright.expect(viewer_tab.page.get_by_role("dialog", name=title)).to_be_visible()
    viewer_tab.page.keyboard.press("Escape")
    playwright.expect(viewer_tab.page.get_by_role("dialog")).to_have_count(0)


def test_the_dialog_of_keys_has_those_of_all_commands(viewer_tab: ViewerTab) -> None:
    viewer_tab.page.keyboard.press("?")
    text = viewer_tab.page.get_by_role("dialog").inner_text()
    for name in ("Save as", "Undo", "Add display", "Zero view", "Show all of it", "Walk"):
        assert name in text
    viewer_tab.page.keyboard.press("Escape")


def test_keys_do_nothing_in_a_dialog_and_letters_nothing_in_a_field(
    viewer: PageBench, viewer_tab: ViewerTab
) -> None:
    viewer_tab.page.keyboard.press("?")
    for key in ("r", "z", "Control+s"):
        viewer_tab.page.keyboard.press(key)
    viewer_tab.page.keyboard.press("Escape")
    field = viewer_tab.page.get_by_placeholder("Filter displays")
    field.click()
    viewer_tab.page.keyboard.type("rz")
    viewer_tab.page.keyboard.press("Control+z")
    viewer_tab.page.keyboard.press("Escape")
    field.fill("")
    field.blur()
    viewer_tab.turn()
    assert viewer.commands == []


TWO_FRAMES = "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"


def test_the_camera_stays_when_a_key_is_a_command(viewer_tab: ViewerTab) -> None:
    eye = "window.__viserMutable.cameraControl.getPosition().toArray().join()"
    before = viewer_tab.page.evaluate(eye)
    for key in ("Control+s", "Control+o"):
        viewer_tab.page.keyboard.press(key)
        viewer_tab.page.keyboard.press("Escape")
    viewer_tab.page.evaluate(TWO_FRAMES)
    assert viewer_tab.page.evaluate(eye) == before


@pytest.fixture
def path_of_changes(viewer: PageBench, viewer_tab: ViewerTab) -> Sequence[str]:
    """Three changes of this browser, as steps of undo; each is a display more."""
    for name in ("Grid", "Path", "Map"):
        viewer.do(AddDisplay(name, {"name": name}), Sender(viewer_tab.browser))
    undo = viewer_tab.page.locator(".wv-head [aria-label=Undo]")
    viewer_tab.wait_for(lambda: undo.get_attribute("data-tip") == "Undo: Add Map")
    return [step.label for step in viewer.history().undo]


def test_buttons_and_keys_undo_and_redo(
    viewer: PageBench, viewer_tab: ViewerTab, path_of_changes: Sequence[str]
) -> None:
    assert path_of_changes == ["Add Map", "Add Path", "Add Grid"]
    keyboard = viewer_tab.page.keyboard
    for act, command, after in [
        (viewer_tab.button("Undo").click, Undo(own=True), "Grid Path"),
        (viewer_tab.button("Redo").click, Redo(own=True), "Grid Path Map"),
        (lambda: keyboard.press("Control+z"), Undo(own=True), "Grid Path"),
        (lambda: keyboard.press("Control+z"), Undo(own=True), "Grid"),
        (lambda: keyboard.press("Control+Shift+z"), Redo(own=True), "Grid Path"),
        (lambda: keyboard.press("Control+y"), Redo(own=True), "Grid Path Map"),
    ]:
        viewer.forget_commands()
        act()
        viewer_tab.wait_for_command(command)
        assert viewer.outline() == after
        viewer_tab.turn()
        viewer_tab.catch_up()  # else there is nothing to redo yet


def test_nothing_can_be_undone_at_first(viewer_tab: ViewerTab) -> None:
    viewer_tab.wait_for(viewer_tab.button("Undo").is_disabled)
    assert viewer_tab.button("Redo").is_disabled()


def test_a_list_of_steps_goes_back_several_at_once(
    viewer: PageBench, viewer_tab: ViewerTab, path_of_changes: Sequence[str]
) -> None:
    viewer_tab.button("Undo").click(button="right")
    items = viewer_tab.page.get_by_role("menuitem")
    assert items.all_inner_texts() == [f"Undo {label}" for label in path_of_changes]
    items.nth(1).click()
    viewer_tab.wait_for_command(Undo(2))
    assert viewer.outline() == "Grid"


@pytest.fixture
def reconnected(viewer_tab: ViewerTab) -> ViewerTab:
    """A page that has lost its connection, as when a viewer starts anew.

    Else it takes the changes of this viewer for ones that others before have made.
    """
    before = viewer_tab.browser
    cut_connections(viewer_tab.viewer.server)
    viewer_tab.wait_for(lambda: viewer_tab.page.evaluate("webviz.browser") not in (None, before))
    viewer_tab.catch_up()
    return viewer_tab


def test_what_was_removed_here_is_brought_back_by_a_toast(
    viewer: PageBench, reconnected: ViewerTab
) -> None:
    viewer.do(AddDisplay("Path", {"name": "Path"}), Sender(reconnected.browser))
    reconnected.page.get_by_role("treeitem", name="Path", exact=True).click()
    reconnected.page.keyboard.press("Delete")
    reconnected.wait_for(lambda: viewer.commands)
    assert viewer.outline() == ""
    toast = reconnected.page.locator(".wv-toast", has_text="Removed Path.")
    toast.get_by_role("button", name="Undo").click()
    reconnected.wait_for_command(Undo(own=True))
    assert viewer.outline() == "Path"


def test_what_others_change_is_told_once(viewer: PageBench, reconnected: ViewerTab) -> None:
    viewer.do(AddDisplay("Grid"), Sender(reconnected.browser))
    undo = reconnected.page.locator(".wv-head [aria-label=Undo]")
    reconnected.wait_for(lambda: undo.get_attribute("data-tip") == "Undo: Add Grid")
    other = Sender(10**6)
    viewer.do(AddDisplay("Path", {"name": "Move <b>Path"}), other)
    text = "Changed in another browser: Add Move <b>Path"
    reconnected.wait_for(lambda: text in reconnected.text())
    for number in range(2002, 2010):
        viewer.do(AddDisplay("Path", {"name": f"Move <b>Path {number}"}), other)
        reconnected.turn()
    toasts = reconnected.page.locator(".wv-toast", has_text="Changed in another browser")
    reconnected.wait_for(lambda: toasts.all_inner_texts() == [f"{text} 2009"])


SAME = """async () => {
  const { toast } = await import("webviz/toasts.js");
  for (let i = 0; i < 3; i++) toast("Not done.", { level: "error" });
  for (let i = 0; i < 9; i++) toast(`Done ${i}.`);
  toast("Not done.", { level: "error" });
}"""
UNDER = """(toast) => {
  const { left, top, height } = toast.getBoundingClientRect();
  return document.elementFromPoint(left + 20, top + height / 2).tagName;
}"""


def test_toasts_are_few_and_leave_the_pointer_to_the_scene(viewer_tab: ViewerTab) -> None:
    viewer_tab.page.evaluate(SAME)
    toasts = viewer_tab.page.locator(".wv-toast")
    assert toasts.all_inner_texts() == ["Done 7.", "Done 8.", "Not done."]
    viewer_tab.page.evaluate(SAME.replace("9", "2"))
    assert toasts.all_inner_texts()[:1] == ["Not done. (5)"]
    assert toasts.first.evaluate(UNDER) == "CANVAS"
    box, size = toasts.first.bounding_box(), viewer_tab.page.viewport_size
    assert box is not None
    assert size is not None
    assert box["y"] > size["height"] / 2
    for _ in range(3):
        toasts.get_by_role("button", name="Dismiss").first.click()
    assert toasts.count() == 0


def test_displays_are_selected_and_looked_at_by_name(
    viewer: PageBench, viewer_tab: ViewerTab
) -> None:
    viewer.show(Grid(name="Front scan"), *named("Map"))
    viewer_tab.wait_for(lambda: "Front scan" in viewer_tab.text())
    run(viewer_tab, "focus front")
    viewer_tab.wait_for_command(FocusDisplay(viewer.id("Front scan")))
    run(viewer_tab, "select map")
    row = viewer_tab.page.get_by_role("treeitem", name="Map")
    playwright.expect(row).to_have_attribute("aria-selected", "true")


def test_shift_f_looks_at_everything_and_ctrl_d_bookmarks_nothing(viewer_tab: ViewerTab) -> None:
    page = viewer_tab.page
    page.keyboard.press("Shift+f")
    viewer_tab.wait_for_command(FocusDisplay(""))
    page.keyboard.press("Control+d")
    playwright.expect(page.get_by_text("Select a display to duplicate it.")).to_be_visible()
