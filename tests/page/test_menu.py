"""Menus over the page."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import playwright.sync_api as playwright
import pytest

from tests.page.tabs import ViewerTab

OPEN = """async ([x, y]) => {
  const { openMenu } = await import("webviz/controls/menu.js");
  const run = (name) => () => { window.ran.push(name) };
  window.ran = [];
  window.closeMenu = openMenu(x, y, [
    { label: "Focus", icon: "focus", key: "f", run: run("Focus") },
    { label: "Rename", disabled: true, run: run("Rename") },
    { label: "Copy", run: run("Copy") },
    null,
    { label: "Remove", danger: true, key: "Delete", run: run("Remove") },
  ]);
}"""


@pytest.fixture
def open_menu(viewer_tab: ViewerTab) -> Callable[..., playwright.Locator]:
    """Open a menu of four, the second of which is disabled."""

    def open_menu(x: float = 400, y: float = 300) -> playwright.Locator:
        viewer_tab.page.mouse.move(5, 5)  # or what lies under it would have the focus
        viewer_tab.page.evaluate(OPEN, [x, y])
        return viewer_tab.page.get_by_role("menu")

    return open_menu


def ran(viewer_tab: ViewerTab) -> list[Any]:
    """Return the executed commands."""
    return viewer_tab.page.evaluate("window.ran")


def test_a_click_does_what_the_item_says_and_closes_the_menu(
    viewer_tab: ViewerTab, open_menu: Callable[..., playwright.Locator]
) -> None:
    menu = open_menu()
    menu.get_by_text("Copy").click()
    assert menu.count() == 0
    assert ran(viewer_tab) == ["Copy"]


def test_arrow_keys_pass_over_what_is_disabled_and_go_around(
    viewer_tab: ViewerTab, open_menu: Callable[..., playwright.Locator]
) -> None:
    open_menu()
    for key in ("ArrowDown", "ArrowDown", "Enter"):
        viewer_tab.page.keyboard.press(key)
    assert ran(viewer_tab) == ["Copy"]
    open_menu()
    for key in ("ArrowDown", "ArrowUp", "Enter"):
        viewer_tab.page.keyboard.press(key)
    assert ran(viewer_tab) == ["Remove"]


def test_a_letter_finds_the_item_that_begins_with_it(
    viewer_tab: ViewerTab, open_menu: Callable[..., playwright.Locator]
) -> None:
    open_menu()
    viewer_tab.page.keyboard.press("c")
    viewer_tab.page.keyboard.press("Enter")
    assert ran(viewer_tab) == ["Copy"]


@pytest.mark.parametrize("leave", ["Escape", "click"])
def test_the_focus_goes_back_when_nothing_is_chosen(
    viewer_tab: ViewerTab, open_menu: Callable[..., playwright.Locator], leave: str
) -> None:
    panel = viewer_tab.page.get_by_role("tab").first
    panel.focus()
    menu = open_menu()
    if leave == "click":
        viewer_tab.page.mouse.click(600, 500)
    else:
        viewer_tab.page.keyboard.press("Escape")
    playwright.expect(menu).to_have_count(0)
    playwright.expect(panel).to_be_focused()
    assert ran(viewer_tab) == []


def test_a_menu_in_a_corner_stays_in_the_window(
    viewer_tab: ViewerTab, open_menu: Callable[..., playwright.Locator]
) -> None:
    size = viewer_tab.page.viewport_size
    assert size is not None
    box = open_menu(size["width"] - 2, size["height"] - 2).bounding_box()
    viewer_tab.page.keyboard.press("Escape")
    assert box is not None
    assert box["x"] + box["width"] <= size["width"]
    assert box["y"] + box["height"] <= size["height"]


def test_choices_are_read_out_as_checked_or_not(viewer_tab: ViewerTab) -> None:
    viewer_tab.button("Menu").click()
    themes = viewer_tab.page.get_by_role("menuitemradio")
    states = themes.evaluate_all("all => all.map((one) => one.getAttribute('aria-checked'))")
    viewer_tab.page.keyboard.press("Escape")
    assert sorted(states) == ["false", "false", "true"]
