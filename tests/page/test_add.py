"""The dialog that adds displays."""

from __future__ import annotations

from typing import Any

import playwright.sync_api as playwright
import pytest

from tests.page.everything import Everything
from tests.page.page_bench import SCAN, PageBench
from tests.page.tabs import ViewerTab
from webviz.api.declared import Topic
from webviz.commands import AddDisplay
from webviz.engine.parts.displays import types_store

BATTERY = "sensor_msgs/msg/BatteryState"
MAP = "nav_msgs/msg/OccupancyGrid"
IMAGE, COMPRESSED = "sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"


def commands(viewer: PageBench) -> list[tuple[str, dict[str, Any]]]:
    """Return the added displays with their properties, which the viewer has."""
    added = [
        (command.type, command.values)
        for command in viewer.commands
        if isinstance(command, AddDisplay)
    ]
    if added:
        assert [row.type for row in viewer.rows][-len(added) :] == [type_ for type_, _ in added]
        names = [values.get("topic") for _, values in added]
        topics = viewer.values("topic.name")[-len(added) :]
        assert [names[i] and topic for i, topic in enumerate(topics)] == names
    return added


@pytest.fixture
def dialog(viewer: PageBench, viewer_tab: ViewerTab) -> playwright.Locator:
    """The dialog by type, while four topics are live."""
    for topic, type_ in {"/back": SCAN, "/front": SCAN, "/map": MAP, "/battery": BATTERY}.items():
        viewer.offer(topic, type_, "/driver")
    viewer.turn()
    return open_dialog(viewer_tab)


def open_dialog(tab: ViewerTab) -> playwright.Locator:
    """The dialog by type."""
    tab.page.keyboard.press("Insert")
    dialog = tab.page.get_by_role("dialog", name="Add display")
    dialog.get_by_role("tab", name="By display").click()
    tab.wait_for(lambda: dialog.get_by_role("option").count() >= 8)
    return dialog


def test_enter_adds_the_best_match_and_closes(
    viewer_tab: ViewerTab, dialog: playwright.Locator
) -> None:
    tab = viewer_tab
    playwright.expect(dialog.get_by_label("Search")).to_be_focused()
    tab.page.keyboard.type("scan")
    playwright.expect(dialog.get_by_role("option")).to_have_count(1)
    laser = "M4 18a9 9 0 0 1 16 0M12 18l-6-9M12 18V7M12 18l6-9"
    playwright.expect(dialog.locator(".wv-pick-icon path")).to_have_attribute("d", laser)
    tab.page.keyboard.press("Enter")
    tab.wait_for(lambda: commands(tab.viewer) == [("LaserScan", {})])
    playwright.expect(dialog).to_have_count(0)


def test_each_type_has_a_line_of_help(dialog: playwright.Locator) -> None:
    grid = dialog.get_by_role("option").filter(has_text="A grid of lines")
    playwright.expect(grid).to_contain_text("A grid of lines for judging distances.")
    assert grid.locator("img").evaluate("image => image.decode().then(() => image.naturalWidth)")
    dialog.press("Escape")


def test_topics_are_shown_with_rate_and_as_text_if_by_nothing_else(
    viewer: PageBench, viewer_tab: ViewerTab
) -> None:
    viewer.offer("/front", SCAN, "/driver")
    viewer.offer("/battery", BATTERY, "/driver")
    viewer.show(Everything(name="a", topic=Topic("/front")))
    viewer.stream_scans("/front", 40.0)
    dialog = open_dialog(viewer_tab)
    dialog.get_by_role("tab", name="By topic").click()
    front = dialog.get_by_role("option").filter(has_text="/front")
    playwright.expect(front).to_contain_text("40 Hz · 1 publisher")
    battery = dialog.get_by_role("option").filter(has_text="/battery")
    playwright.expect(battery).to_contain_text(f"Text · {BATTERY}")
    playwright.expect(battery).to_be_enabled()
    dialog.press("Escape")


def test_topics_that_are_shown_already_come_after_those_that_are_not(
    viewer: PageBench, viewer_tab: ViewerTab, dialog: playwright.Locator
) -> None:
    viewer.show(Everything(name="a", topic=Topic("back")))
    dialog.get_by_role("tab", name="By topic").click()
    titles = dialog.locator(".wv-pick-title")
    viewer_tab.wait_for(
        lambda: titles.all_inner_texts() == ["/front", "/map", "/back", "/battery", "/tf_static"]
    )
    assert [text for text in dialog.get_by_role("option").all_inner_texts() if "shown" in text] == [
        dialog.get_by_role("option").filter(has_text="/back").inner_text()
    ]
    dialog.press("Escape")


def test_several_topics_are_added_at_once(
    viewer_tab: ViewerTab, dialog: playwright.Locator
) -> None:
    tab = viewer_tab
    dialog.get_by_role("tab", name="By topic").click()
    for topic in ("/front", "/back"):
        dialog.get_by_role("option").filter(has_text=topic).click()
    dialog.get_by_role("button", name="Add 2 displays").click()
    added = [("LaserScan", {"topic": "/front"}), ("LaserScan", {"topic": "/back"})]
    tab.wait_for(lambda: commands(tab.viewer) == added)


def test_a_double_click_adds_a_topic(viewer_tab: ViewerTab, dialog: playwright.Locator) -> None:
    tab = viewer_tab
    dialog.get_by_role("tab", name="By topic").click()
    dialog.get_by_role("option").filter(has_text="/front").dblclick()
    tab.wait_for(lambda: commands(tab.viewer) == [("LaserScan", {"topic": "/front"})])
    playwright.expect(dialog).to_have_count(0)


def test_topics_are_first_and_an_image_is_there_once_with_its_displays(
    viewer_tab: ViewerTab,
) -> None:
    tab = viewer_tab
    kinds = {"": IMAGE, "/compressed": COMPRESSED, "/compressedDepth": COMPRESSED}
    for name, type_ in kinds.items():
        tab.viewer.offer(f"/camera{name}", type_, "/driver")
    tab.page.evaluate("localStorage.clear()")
    tab.page.keyboard.press("Insert")
    dialog = tab.page.get_by_role("dialog", name="Add display")
    tabs = dialog.get_by_role("tab")
    assert tabs.all_inner_texts() == ["By topic", "By display"]
    playwright.expect(tabs.first).to_have_attribute("aria-selected", "true")
    rows = dialog.get_by_role("option", name="Image", exact=False).filter(has_text="Image")
    tab.wait_for(lambda: rows.count() >= 3)
    assert dialog.get_by_text("/camera", exact=True).count() == 1
    names = dialog.get_by_role("option").all_inner_texts()
    assert len(names) == len(set(names)), "each display and transport once"
    tab.page.keyboard.type("compressedDepth image")
    dialog.get_by_role("option", name="/camera/compressedDepth Image", exact=True).dblclick()
    added = [("Image", {"topic": "/camera/compressedDepth"})]
    tab.wait_for(lambda: commands(tab.viewer) == added)


def test_enter_adds_the_best_topic(viewer_tab: ViewerTab, dialog: playwright.Locator) -> None:
    tab = viewer_tab
    dialog.get_by_role("tab", name="By topic").click()
    tab.page.keyboard.type("ma")
    tab.page.keyboard.press("Enter")
    tab.wait_for(lambda: commands(tab.viewer) == [("Map", {"topic": "/map"})])


def test_a_topic_that_appears_is_shown_and_a_check_mark_stays(
    viewer_tab: ViewerTab, dialog: playwright.Locator
) -> None:
    tab = viewer_tab
    dialog.get_by_role("tab", name="By topic").click()
    dialog.get_by_role("option").filter(has_text="/front").click()
    tab.viewer.offer("/a", SCAN, "/driver")
    first = dialog.get_by_role("option").first
    tab.wait_for(lambda: first.inner_text().startswith("/a"))
    front = dialog.get_by_role("option").filter(has_text="/front")
    playwright.expect(front).to_have_attribute("aria-checked", "true")
    dialog.get_by_role("button", name="Cancel").click()
    assert tab.viewer.commands == []


def test_types_have_the_messages_that_they_show_an_icon_and_a_small_picture() -> None:
    result = types_store().types
    assert result["LaserScan"].topics == [SCAN]
    assert (result["LaserScan"].icon, result["Wrench"].icon) == ("laser", "plug")
    sizes = {name: len(each.picture) for name, each in result.items() if "Everything" not in name}
    assert {name for name, size in sizes.items() if not size} == {"Group", "MapInfo"}, (
        "they draw nothing"
    )
    assert sum(sizes.values()) < 1500 * len(sizes)


def test_a_closed_dialog_costs_nothing(viewer_tab: ViewerTab, dialog: playwright.Locator) -> None:
    tab = viewer_tab
    assert {"topics", "traffic", "types"} <= tab.viewer.server.channel.watched()
    dialog.get_by_role("button", name="Cancel").click()
    tab.wait_for(lambda: not {"topics", "traffic", "types"} & tab.viewer.server.channel.watched())
    assert dialog.count() == 0
