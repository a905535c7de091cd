"""The dialog that adds displays."""

from __future__ import annotations

from collections.abc import Callable

import playwright.sync_api as playwright
import pytest

from tests.page.conftest import Loop, Tab
from webviz.api.declared import Topic
from webviz.commands import AddDisplay
from webviz.engine.parts.displays import types_store
from webviz.engine.state import Row, Traffic
from webviz.scene.server import Server
from webviz.sources import Offer, Publisher

SCAN, BATTERY = "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/BatteryState"
MAP = "nav_msgs/msg/OccupancyGrid"
IMAGE, COMPRESSED = "sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"


def offer(type_: str) -> Offer:
    return Offer((Publisher("/driver", type_, "reliable", "volatile"),))


OFFERS = {
    "/back": offer(SCAN),
    "/front": offer(SCAN),
    "/map": offer(MAP),
    "/battery": offer(BATTERY),
}


def commands(loop: Loop) -> list[tuple[str, object]]:
    """Return the added displays with their properties."""
    return [
        (command.type, command.values)
        for command in loop.commands
        if isinstance(command, AddDisplay)
    ]


@pytest.fixture
def dialog(tab: Tab) -> playwright.Locator:
    """The dialog by type, while four topics are live."""
    tab.loop.show(offers=OFFERS, traffic={"/front": Traffic(39.84, 1e4)})
    tab.page.keyboard.press("Insert")
    dialog = tab.page.get_by_role("dialog", name="Add display")
    dialog.get_by_role("tab", name="By display").click()
    tab.wait_for(lambda: dialog.get_by_role("option").count() >= 8)
    return dialog


def test_enter_adds_the_best_match_and_closes(tab: Tab, dialog: playwright.Locator) -> None:
    playwright.expect(dialog.get_by_label("Search")).to_be_focused()
    tab.page.keyboard.type("scan")
    playwright.expect(dialog.get_by_role("option")).to_have_count(1)
    laser = "M4 18a9 9 0 0 1 16 0M12 18l-6-9M12 18V7M12 18l6-9"
    playwright.expect(dialog.locator(".wv-pick-icon path")).to_have_attribute("d", laser)
    tab.page.keyboard.press("Enter")
    tab.wait_for(lambda: commands(tab.loop) == [("LaserScan", {})])
    playwright.expect(dialog).to_have_count(0)


def test_each_type_has_a_line_of_help(dialog: playwright.Locator) -> None:
    grid = dialog.get_by_role("option").filter(has_text="A grid of lines")
    playwright.expect(grid).to_contain_text("A grid of lines for judging distances.")
    assert grid.locator("img").evaluate("image => image.decode().then(() => image.naturalWidth)")
    dialog.press("Escape")


def test_topics_are_shown_with_rate_and_as_text_if_by_nothing_else(
    tab: Tab, dialog: playwright.Locator
) -> None:
    dialog.get_by_role("tab", name="By topic").click()
    front = dialog.get_by_role("option").filter(has_text="/front")
    playwright.expect(front).to_contain_text("40 Hz · 1 publisher")
    battery = dialog.get_by_role("option").filter(has_text="/battery")
    playwright.expect(battery).to_contain_text(f"Text · {BATTERY}")
    playwright.expect(battery).to_be_enabled()
    dialog.press("Escape")


def test_topics_that_are_shown_already_come_after_those_that_are_not(
    tab: Tab, dialog: playwright.Locator, make_row: Callable[..., Row]
) -> None:
    tab.loop.show(make_row("a", topic=Topic("back")))
    dialog.get_by_role("tab", name="By topic").click()
    titles = dialog.locator(".wv-pick-title")
    tab.wait_for(lambda: titles.all_inner_texts() == ["/front", "/map", "/back", "/battery"])
    assert [text for text in dialog.get_by_role("option").all_inner_texts() if "shown" in text] == [
        dialog.get_by_role("option").filter(has_text="/back").inner_text()
    ]
    dialog.press("Escape")


def test_several_topics_are_added_at_once(tab: Tab, dialog: playwright.Locator) -> None:
    dialog.get_by_role("tab", name="By topic").click()
    for topic in ("/front", "/back"):
        dialog.get_by_role("option").filter(has_text=topic).click()
    dialog.get_by_role("button", name="Add 2 displays").click()
    added = [("LaserScan", {"topic": "/front"}), ("LaserScan", {"topic": "/back"})]
    tab.wait_for(lambda: commands(tab.loop) == added)


def test_a_double_click_adds_a_topic(tab: Tab, dialog: playwright.Locator) -> None:
    dialog.get_by_role("tab", name="By topic").click()
    dialog.get_by_role("option").filter(has_text="/front").dblclick()
    tab.wait_for(lambda: commands(tab.loop) == [("LaserScan", {"topic": "/front"})])
    playwright.expect(dialog).to_have_count(0)


def test_topics_are_first_and_an_image_is_there_once_with_its_displays(tab: Tab) -> None:
    kinds = {"": IMAGE, "/compressed": COMPRESSED, "/compressedDepth": COMPRESSED}
    tab.loop.show(offers={f"/camera{name}": offer(type_) for name, type_ in kinds.items()})
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
    tab.wait_for(lambda: commands(tab.loop) == added)


def test_enter_adds_the_best_topic(tab: Tab, dialog: playwright.Locator) -> None:
    dialog.get_by_role("tab", name="By topic").click()
    tab.page.keyboard.type("ma")
    tab.page.keyboard.press("Enter")
    tab.wait_for(lambda: commands(tab.loop) == [("Map", {"topic": "/map"})])


def test_a_topic_that_appears_is_shown_and_a_check_mark_stays(
    tab: Tab, dialog: playwright.Locator
) -> None:
    dialog.get_by_role("tab", name="By topic").click()
    dialog.get_by_role("option").filter(has_text="/front").click()
    tab.loop.show(offers={**OFFERS, "/a": offer(SCAN)})
    first = dialog.get_by_role("option").first
    tab.wait_for(lambda: first.inner_text().startswith("/a"))
    front = dialog.get_by_role("option").filter(has_text="/front")
    playwright.expect(front).to_have_attribute("aria-checked", "true")
    dialog.get_by_role("button", name="Cancel").click()
    assert tab.loop.commands == []


def test_types_have_the_messages_that_they_show_an_icon_and_a_small_picture() -> None:
    result = types_store().types
    assert result["LaserScan"].topics == [SCAN]
    assert (result["LaserScan"].icon, result["Wrench"].icon) == ("laser", "plug")
    sizes = {name: len(each.picture) for name, each in result.items() if "Everything" not in name}
    assert {name for name, size in sizes.items() if not size} == {"Group", "MapInfo"}, (
        "they draw nothing"
    )
    assert sum(sizes.values()) < 1500 * len(sizes)


def test_a_closed_dialog_costs_nothing(
    tab: Tab, server: Server, dialog: playwright.Locator
) -> None:
    assert {"topics", "traffic", "types"} <= server.channel.watched()
    dialog.get_by_role("button", name="Cancel").click()
    tab.wait_for(lambda: not {"topics", "traffic", "types"} & server.channel.watched())
    assert dialog.count() == 0
