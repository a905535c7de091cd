"""Menus over the page."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import playwright.sync_api as playwright
import pytest

from tests.page.conftest import Tab

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
def open_menu(tab: Tab) -> Callable[..., playwright.Locator]:
    """Open a menu of four, the second of which is disabled."""

    def open_menu(x: float = 400, y: float = 300) -> playwright.Locator:
        tab.page.mouse.move(5, 5)  # or what lies under it would have the focus
        tab.page.evaluate(OPEN, [x, y])
        return tab.page.get_by_role("menu")

    return open_menu


def ran(tab: Tab) -> Any:
    """Return the executed commands."""
    return tab.page.evaluate("window.ran")


def test_a_click_does_what_the_item_says_and_closes_the_menu(
    tab: Tab, open_menu: Callable[..., playwright.Locator]
) -> None:
    menu = open_menu()
    menu.get_by_text("Copy").click()
    assert menu.count() == 0
    assert ran(tab) == ["Copy"]


def test_arrow_keys_pass_over_what_is_disabled_and_go_around(
    tab: Tab, open_menu: Callable[..., playwright.Locator]
) -> None:
    open_menu()
    for key in ("ArrowDown", "ArrowDown", "Enter"):
        tab.page.keyboard.press(key)
    assert ran(tab) == ["Copy"]
    open_menu()
    for key in ("ArrowDown", "ArrowUp", "Enter"):
        tab.page.keyboard.press(key)
    assert ran(tab) == ["Remove"]


def test_a_letter_finds_the_item_that_begins_with_it(
    tab: Tab, open_menu: Callable[..., playwright.Locator]
) -> None:
    open_menu()
    tab.page.keyboard.press("c")
    tab.page.keyboard.press("Enter")
    assert ran(tab) == ["Copy"]


@pytest.mark.parametrize("leave", ["Escape", "click"])
def test_the_focus_goes_back_when_nothing_is_chosen(
    tab: Tab, open_menu: Callable[..., playwright.Locator], leave: str
) -> None:
    panel = tab.page.get_by_role("tab").first
    panel.focus()
    menu = open_menu()
    if leave == "click":
        tab.page.mouse.click(600, 500)
    else:
        tab.page.keyboard.press("Escape")
    playwright.expect(menu).to_have_count(0)
    playwright.expect(panel).to_be_focused()
    assert ran(tab) == []


def test_a_menu_in_a_corner_stays_in_the_window(
    tab: Tab, open_menu: Callable[..., playwright.Locator]
) -> None:
    size = tab.page.viewport_size
    assert size is not None
    box = open_menu(size["width"] - 2, size["height"] - 2).bounding_box()
    tab.page.keyboard.press("Escape")
    assert box is not None
    assert box["x"] + box["width"] <= size["width"]
    assert box["y"] + box["height"] <= size["height"]


def test_choices_are_read_out_as_checked_or_not(tab: Tab) -> None:
    tab.button("Menu").click()
    themes = tab.page.get_by_role("menuitemradio")
    states = themes.evaluate_all("all => all.map((one) => one.getAttribute('aria-checked'))")
    tab.page.keyboard.press("Escape")
    assert sorted(states) == ["false", "false", "true"]
