"""The list of commands, keys, and undo and redo."""

from __future__ import annotations

from collections.abc import Callable

import playwright.sync_api as playwright
import pytest

from tests.page.conftest import Loop, Tab
from webviz.api.views import Orbit
from webviz.commands import (
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
from webviz.engine.commands import Command
from webviz.engine.state import ConfigFile, Row
from webviz.features.undo import HistoryStep, UndoHistory
from webviz.files.config import Settings

LAB = ConfigFile("/home/me/lab.yaml", False, "/home/me", ("lab.yaml",))


def open_list(tab: Tab) -> playwright.Locator:
    tab.page.keyboard.press("Control+k")
    return tab.page.get_by_role("dialog", name="Commands")


def run(tab: Tab, words: str) -> None:
    """Do what the list finds by these words."""
    open_list(tab).get_by_role("combobox").fill(words)
    tab.page.keyboard.press("Enter")


def test_the_list_follows_a_frame_and_puts_it_into_the_middle(tab: Tab, loop: Loop) -> None:
    loop.show(frames=("map", "odom"))
    open_list(tab)
    tab.wait_for(lambda: "Follow odom" in tab.text())
    tab.page.get_by_role("dialog").get_by_role("combobox").fill("follow odom")
    tab.page.keyboard.press("Enter")
    tab.wait_for(lambda: len(loop.commands) == 2)
    followed, centred = loop.commands
    assert isinstance(followed, ChangeView)
    assert (followed.key, followed.value) == ("target_frame", "odom")
    assert isinstance(centred, FocusFrame)
    assert centred.frame == "odom"


def test_the_list_finds_what_keys_do_in_the_tree(
    tab: Tab, loop: Loop, make_row: Callable[..., Row]
) -> None:
    loop.show(make_row("a"))
    tab.page.get_by_role("treeitem", name="a", exact=True).click()
    tab.page.mouse.move(800, 400)
    for name in ("Rename display", "Remove display", "Filter displays"):
        dialog = open_list(tab)
        dialog.get_by_role("combobox").fill(name)
        dialog.get_by_role("option", name=name).wait_for()
        tab.page.keyboard.press("Escape")
    run(tab, "remove display")
    tab.wait_for_command(RemoveDisplay("a"))


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
    tab: Tab, loop: Loop, words: str, command: Command
) -> None:
    loop.show(frames=("map", "odom"), settings=Settings(views={"kitchen": Orbit()}))
    tab.turn()
    open_list(tab)
    tab.wait_for(lambda: "Fixed frame: odom" in tab.text())
    tab.page.get_by_role("dialog").get_by_role("combobox").fill(words)
    tab.page.keyboard.press("Enter")
    tab.wait_for_command(command)


def test_arrow_keys_choose_in_the_list_while_the_field_has_the_focus(tab: Tab) -> None:
    dialog = open_list(tab)
    dialog.get_by_role("combobox").fill("theme")
    tab.page.keyboard.press("ArrowDown")
    playwright.expect(dialog.get_by_role("option", selected=True)).to_have_text("Theme: light")
    playwright.expect(dialog.get_by_role("combobox")).to_be_focused()
    tab.page.keyboard.press("Escape")


def test_every_command_of_the_list_has_an_icon(tab: Tab) -> None:
    dialog = open_list(tab)
    dialog.get_by_role("option").first.wait_for()
    without = dialog.get_by_role("option").filter(has_not=tab.page.locator("svg"))
    assert without.count() == 0
    tab.page.keyboard.press("Escape")


def test_the_list_opens_once_and_visers_does_not(tab: Tab) -> None:
    open_list(tab)
    tab.page.keyboard.press("Control+k")
    tab.turn()
    assert tab.page.get_by_role("dialog").count() == 1
    tab.page.keyboard.press("Escape")
    assert tab.page.locator(".mantine-Spotlight-root").count() == 0


@pytest.mark.parametrize(
    ("keys", "command"), [("Control+s", Save()), ("r", Reset()), ("z", ResetView())]
)
def test_keys_do_what_rviz_does(tab: Tab, loop: Loop, keys: str, command: Command) -> None:
    loop.show(file=LAB)
    tab.wait_for(lambda: "lab.yaml" in tab.text())
    tab.page.keyboard.press(keys)
    tab.wait_for_command(command)


def test_the_dialog_of_keys_has_those_of_commands_and_of_parts(tab: Tab) -> None:
    tab.page.keyboard.press("?")
    dialog = tab.page.get_by_role("dialog", name="Keyboard and mouse")
    for group, does, keys in (
        ("File", "Save", "Ctrl+S"),
        ("Tree of displays", "Move in the list", "Alt+↑Alt+↓"),
        ("Image", "Zoom", "Wheel+-"),
        ("Plot", "Move in time", "←→"),
        ("While driving", "Drive", "WASD"),
        ("Scene", "Look at what is under the mouse", "F"),
    ):
        section = dialog.locator("section").filter(has=tab.page.get_by_role("heading", name=group))
        row = section.locator("dl > div").filter(has=tab.page.locator("dt", has_text=does)).first
        assert row.locator("dd").inner_text().replace("\n", "") == keys
    tab.page.keyboard.press("Escape")


@pytest.mark.parametrize(
    ("keys", "title"),
    [
        ("Control+o", "Open"),
        ("Control+Shift+s", "Save as"),
        ("Insert", "Add display"),
        ("?", "Keyboard and mouse"),
    ],
)
def test_keys_open_dialogs(tab: Tab, keys: str, title: str) -> None:
    tab.page.keyboard.press(keys)
    playwright.expect(tab.page.get_by_role("dialog", name=title)).to_be_visible()
    tab.page.keyboard.press("Escape")
    playwright.expect(tab.page.get_by_role("dialog")).to_have_count(0)


def test_the_dialog_of_keys_has_those_of_all_commands(tab: Tab) -> None:
    tab.page.keyboard.press("?")
    text = tab.page.get_by_role("dialog").inner_text()
    for name in ("Save as", "Undo", "Add display", "Zero view", "Show all of it", "Walk"):
        assert name in text
    tab.page.keyboard.press("Escape")


def test_keys_do_nothing_in_a_dialog_and_letters_nothing_in_a_field(tab: Tab, loop: Loop) -> None:
    tab.page.keyboard.press("?")
    for key in ("r", "z", "Control+s"):
        tab.page.keyboard.press(key)
    tab.page.keyboard.press("Escape")
    field = tab.page.get_by_placeholder("Filter displays")
    field.click()
    tab.page.keyboard.type("rz")
    tab.page.keyboard.press("Control+z")
    tab.page.keyboard.press("Escape")
    field.fill("")
    field.blur()
    tab.turn()
    assert loop.commands == []


TWO_FRAMES = "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"


def test_the_camera_stays_when_a_key_is_a_command(tab: Tab) -> None:
    eye = "window.__viserMutable.cameraControl.getPosition().toArray().join()"
    before = tab.page.evaluate(eye)
    for key in ("Control+s", "Control+o"):
        tab.page.keyboard.press(key)
        tab.page.keyboard.press("Escape")
    tab.page.evaluate(TWO_FRAMES)
    assert tab.page.evaluate(eye) == before


def steps(*labels: str, browser: int | None = None, first: int = 1) -> tuple[HistoryStep, ...]:
    """Steps with these labels, the newest first."""
    made = [HistoryStep(first + index, label, browser) for index, label in enumerate(labels)]
    return tuple(reversed(made))


def show_history(tab: Tab, history: UndoHistory) -> None:
    tab.loop.show(history=history)
    expected = f"Undo: {history.undo[0].label}" if history.undo else "Undo"
    undo = tab.page.locator(".wv-head [aria-label=Undo]")
    tab.wait_for(lambda: undo.get_attribute("data-tip") == expected)


def test_buttons_and_keys_undo_and_redo(tab: Tab) -> None:
    show_history(tab, UndoHistory(steps("Move Path"), steps("Hide Map")))
    for act, command in [
        (tab.button("Undo").click, Undo(own=True)),
        (tab.button("Redo").click, Redo(own=True)),
        (lambda: tab.page.keyboard.press("Control+z"), Undo(own=True)),
        (lambda: tab.page.keyboard.press("Control+Shift+z"), Redo(own=True)),
        (lambda: tab.page.keyboard.press("Control+y"), Redo(own=True)),
    ]:
        tab.loop.commands.clear()
        act()
        tab.wait_for_command(command)


def test_nothing_can_be_undone_at_first(tab: Tab) -> None:
    show_history(tab, UndoHistory())
    assert tab.button("Undo").is_disabled()
    assert tab.button("Redo").is_disabled()


def test_a_list_of_steps_goes_back_several_at_once(tab: Tab) -> None:
    show_history(tab, UndoHistory(steps("Add Grid", "Move Path", "Hide Map")))
    tab.button("Undo").click(button="right")
    items = tab.page.get_by_role("menuitem")
    assert items.all_inner_texts() == ["Undo Hide Map", "Undo Move Path", "Undo Add Grid"]
    items.nth(1).click()
    tab.wait_for_command(Undo(2))


def test_what_was_removed_here_is_brought_back_by_a_toast(tab: Tab) -> None:
    show_history(tab, UndoHistory())
    browser = tab.page.evaluate("window.webviz.browser")
    step = HistoryStep(1001, "Remove Path", browser, removed="Path")
    show_history(tab, UndoHistory((step,)))
    toast = tab.page.locator(".wv-toast", has_text="Removed Path.")
    toast.get_by_role("button", name="Undo").click()
    tab.wait_for_command(Undo(own=True))


def test_what_others_change_is_told_once(tab: Tab) -> None:
    show_history(tab, UndoHistory())
    show_history(tab, UndoHistory(steps("Move <b>Path", browser=10**6, first=2001)))
    text = "Changed in another browser: Move <b>Path"
    tab.wait_for(lambda: text in tab.text())
    for number in range(2002, 2010):
        label = f"Move <b>Path {number}"
        show_history(tab, UndoHistory(steps(label, browser=10**6, first=number)))
    toasts = tab.page.locator(".wv-toast", has_text="Changed in another browser")
    tab.wait_for(lambda: toasts.all_inner_texts() == [f"{text} 2009"])


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


def test_toasts_are_few_and_leave_the_pointer_to_the_scene(tab: Tab) -> None:
    tab.page.evaluate(SAME)
    toasts = tab.page.locator(".wv-toast")
    assert toasts.all_inner_texts() == ["Done 7.", "Done 8.", "Not done."]
    tab.page.evaluate(SAME.replace("9", "2"))
    assert toasts.all_inner_texts()[:1] == ["Not done. (5)"]
    assert toasts.first.evaluate(UNDER) == "CANVAS"
    box, size = toasts.first.bounding_box(), tab.page.viewport_size
    assert box is not None
    assert size is not None
    assert box["y"] > size["height"] / 2
    for _ in range(3):
        toasts.get_by_role("button", name="Dismiss").first.click()
    assert toasts.count() == 0


def test_displays_are_selected_and_looked_at_by_name(
    tab: Tab, loop: Loop, make_row: Callable[..., Row]
) -> None:
    loop.show(make_row("a", "Front scan"), make_row("b", "Map"))
    tab.wait_for(lambda: "Front scan" in tab.text())
    run(tab, "focus front")
    tab.wait_for_command(FocusDisplay("a"))
    run(tab, "select map")
    row = tab.page.get_by_role("treeitem", name="Map")
    playwright.expect(row).to_have_attribute("aria-selected", "true")


def test_shift_f_looks_at_everything_and_ctrl_d_bookmarks_nothing(tab: Tab) -> None:
    tab.page.keyboard.press("Shift+f")
    tab.wait_for_command(FocusDisplay(""))
    tab.page.keyboard.press("Control+d")
    playwright.expect(tab.page.get_by_text("Select a display to duplicate it.")).to_be_visible()
