"""The side with its panels: width, folding, tabs, and how the header shows the file."""

from __future__ import annotations

import re
from collections.abc import Iterator

import playwright.sync_api as playwright
import pytest
from pages import bounds

from tests.page.everything import Everything, group, named
from tests.page.page_bench import PageBench
from tests.page.tabs import HEIGHT, WIDTH, ViewerTab
from tests.page.trees import Tree, height_of
from webviz.shell.testing.source import SECOND

TIME_S = 1_764_000_000
"""ROS time of these tests."""


@pytest.fixture
def wide(viewer_tab: ViewerTab) -> Iterator[ViewerTab]:
    """The tab with room for the ROS time beside the timeline."""
    viewer_tab.page.set_viewport_size({"width": 1300, "height": HEIGHT})
    yield viewer_tab
    viewer_tab.page.set_viewport_size({"width": WIDTH, "height": HEIGHT})


def shows_seconds(tab: ViewerTab) -> bool:
    """Return whether the ROS time is written in seconds."""
    text = tab.page.locator(".wv-ros-time").inner_text()
    return re.fullmatch(rf"{TIME_S}\.\d+", text) is not None


def width(tab: ViewerTab) -> float:
    box = bounds(tab.page.get_by_role("complementary", name="Panels"))
    return box["width"]


def test_a_reload_keeps_sizes_folds_the_selection_and_how_times_are_written(
    viewer: PageBench, wide: ViewerTab
) -> None:
    tab, tree = wide, Tree(wide)
    viewer.source.now = TIME_S * SECOND
    viewer.show(*named("a"), group("g", Everything(name="b")))
    tree.click("a")
    tree.fold("g")
    border = tab.page.get_by_role("separator", name="Height of the properties")
    height = height_of(tree.details)
    tree.drag_by(border, 0, -60)
    assert height_of(tree.details) == pytest.approx(height + 60, abs=2)
    border.press("ArrowDown")
    assert height_of(tree.details) == pytest.approx(height + 36, abs=2)
    tab.page.locator(".wv-ros-time").click()
    tab.wait_for(lambda: shows_seconds(tab))
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
    tree.wait_for_names("a", "g")
    tab.wait_for(tree.details.is_visible)
    assert tree.selected() == ["a"]
    assert height_of(tree.details) == pytest.approx(height + 36, abs=2)
    assert width(tab) == dragged
    tab.wait_for(lambda: shows_seconds(tab))

    tab.page.get_by_role("separator", name="Width of the panels").dblclick()
    assert width(tab) == before
    border.dblclick()
    assert not tree.details.is_visible()
    tree.fold("g")
    tab.page.locator(".wv-ros-time").click()
    tab.wait_for(lambda: not shows_seconds(tab))


def test_arrow_keys_move_the_border_and_not_the_camera(viewer_tab: ViewerTab) -> None:
    tab = viewer_tab
    eye = "window.__viserMutable.cameraControl.getPosition().toArray().join()"
    before, camera = width(tab), tab.page.evaluate(eye)
    border = tab.page.get_by_role("separator", name="Width of the panels")
    border.press("ArrowRight")
    assert width(tab) == before + 16
    border.press("ArrowLeft")
    assert width(tab) == before
    assert tab.page.evaluate(eye) == camera


def test_a_key_folds_the_side_and_a_button_brings_it_back(viewer_tab: ViewerTab) -> None:
    tab = viewer_tab
    side = tab.page.get_by_role("complementary", name="Panels")
    tab.page.keyboard.press("Control+b")
    playwright.expect(side).to_be_hidden()
    tab.button("Show the panels").click()
    playwright.expect(side).to_be_visible()
    playwright.expect(tab.button("Show the panels")).to_be_hidden()


def test_a_panel_is_opened_by_its_tab_and_by_arrow_keys(viewer_tab: ViewerTab) -> None:
    tabs = viewer_tab.page.get_by_role("tablist", name="Panels").get_by_role("tab")
    tabs.first.click()
    tabs.first.press("ArrowRight")
    playwright.expect(tabs.nth(1)).to_be_focused()
    playwright.expect(tabs.nth(1)).to_have_attribute("aria-selected", "true")
    tabs.nth(1).press("ArrowLeft")
    playwright.expect(tabs.first).to_have_attribute("aria-selected", "true")
