"""The side with its panels: width, folding, tabs, and how the header shows the file."""

from __future__ import annotations

import playwright.sync_api as playwright

from tests.page.conftest import Tab


def width(tab: Tab) -> float:
    box = tab.page.get_by_role("complementary", name="Panels").bounding_box()
    assert box is not None
    return box["width"]


def test_the_side_is_as_wide_as_its_border_is_dragged_also_after_a_reload(tab: Tab) -> None:
    before = width(tab)
    tab.page.mouse.move(before, 400)
    tab.page.mouse.down()
    tab.page.mouse.move(before + 60, 400, steps=4)
    tab.page.mouse.up()
    assert abs(width(tab) - before - 60) <= 2
    canvas = tab.page.locator("#root canvas").first
    tab.wait_for(lambda: (canvas.bounding_box() or {"x": 0})["x"] == width(tab))
    dragged = width(tab)
    tab.page.reload()
    tab.page.get_by_role("tablist").first.wait_for()
    assert width(tab) == dragged
    tab.page.get_by_role("separator", name="Width of the panels").dblclick()
    assert width(tab) == before


def test_arrow_keys_move_the_border_and_not_the_camera(tab: Tab) -> None:
    eye = "window.__viserMutable.cameraControl.getPosition().toArray().join()"
    before, camera = width(tab), tab.page.evaluate(eye)
    border = tab.page.get_by_role("separator", name="Width of the panels")
    border.press("ArrowRight")
    assert width(tab) == before + 16
    border.press("ArrowLeft")
    assert width(tab) == before
    assert tab.page.evaluate(eye) == camera


def test_a_key_folds_the_side_and_a_button_brings_it_back(tab: Tab) -> None:
    side = tab.page.get_by_role("complementary", name="Panels")
    tab.page.keyboard.press("Control+b")
    playwright.expect(side).to_be_hidden()
    tab.button("Show the panels").click()
    playwright.expect(side).to_be_visible()
    playwright.expect(tab.button("Show the panels")).to_be_hidden()


def test_a_panel_is_opened_by_its_tab_and_by_arrow_keys(tab: Tab) -> None:
    tabs = tab.page.get_by_role("tablist", name="Panels").get_by_role("tab")
    tabs.first.click()
    tabs.first.press("ArrowRight")
    playwright.expect(tabs.nth(1)).to_be_focused()
    playwright.expect(tabs.nth(1)).to_have_attribute("aria-selected", "true")
    tabs.nth(1).press("ArrowLeft")
    playwright.expect(tabs.first).to_have_attribute("aria-selected", "true")
