"""The panel "Topics"."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

import numpy as np
import playwright.sync_api as playwright
import pytest
from shown_stores import shown_by

from tests.page.conftest import HEIGHT, WIDTH, Loop, Tab
from webviz.api import registry
from webviz.api.declared import Topic
from webviz.api.display import Display, Input
from webviz.commands import AddDisplay, InspectTopics
from webviz.data.messages import LaserScan, to_tree
from webviz.engine.state import Inspected, State, Traffic
from webviz.sources import Offer, Publisher

HOSTILE = "<img src=x onerror=alert(1)>"
CLOUD = "test_msgs/msg/Cloud"
SCAN = Publisher("/driver", "sensor_msgs/msg/LaserScan", "best_effort", "volatile")
MAP = Publisher("/server", "nav_msgs/msg/OccupancyGrid", "reliable", "transient_local")
IMU = Publisher("/imu", "sensor_msgs/msg/Imu", "reliable", "volatile")
BOTH = Publisher("/camera", CLOUD, "reliable", "volatile")


class Dots(Display):
    topic: Annotated[Topic, Input(CLOUD)] = Topic()


class Boxes(Display):
    source: Annotated[Topic, Input(CLOUD)] = Topic()


@pytest.fixture(autouse=True)
def _displays() -> Iterator[None]:
    registry.register("tests", {"Dots": Dots, "Boxes": Boxes})
    yield
    registry.register("tests", {})


@pytest.fixture
def panel(tab: Tab) -> Iterator[Tab]:
    """The tab with the panel open."""
    tab.show_tab("Topics")
    tab.page.get_by_role("searchbox").fill("")
    yield tab
    tab.page.evaluate("localStorage.removeItem('webviz.topics-sort')")
    tab.show_tab("Displays")


def names(tab: Tab) -> list[str]:
    """The topics that are seen, from top to bottom."""
    return tab.page.locator(".wv-topic .wv-cell-name").all_inner_texts()


def row(tab: Tab, name: str) -> str:
    """Return the text of a row in one line."""
    rows = tab.page.locator(".wv-topic").all_inner_texts()
    lines = [" ".join(text.split()) for text in rows]
    return next((line for line in lines if line.startswith(name)), "")


def choose(tab: Tab, name: str) -> None:
    tab.wait_for(lambda: name in names(tab))
    tab.page.locator(".wv-cell-name").get_by_text(name, exact=True).click()


def show(loop: Loop, **publishers: tuple[Publisher, ...]) -> None:
    loop.show(offers={f"/{name}": Offer(each) for name, each in publishers.items()})


def test_a_topic_has_its_facts_in_a_row(loop: Loop, panel: Tab) -> None:
    offers = {"/scan": Offer((SCAN,), subscribers=3), HOSTILE: Offer((MAP, MAP), subscribers=0)}
    loop.show(offers=offers, traffic={"/scan": Traffic(10.04, 45_300.0, 0.0061)})
    panel.wait_for(lambda: "10.0 Hz" in row(panel, "/scan"))
    scan = row(panel, "/scan")
    assert scan == "/scan sensor_msgs/LaserScan 1 pub 3 subs 10.0 Hz 45.0 kB/s"
    assert "2 pubs 0 subs" in row(panel, HOSTILE)


def test_a_wide_panel_has_all_columns(loop: Loop, panel: Tab) -> None:
    wide = panel
    wide.page.evaluate("async () => (await import('webviz/remember.js')).remember('width', 850)")
    wide.page.set_viewport_size({"width": 1310, "height": HEIGHT})
    loop.show(
        offers={"/scan": Offer((SCAN,), subscribers=1)},
        traffic={"/scan": Traffic(10.04, 45_300.0, 0.0061)},
    )
    wide.wait_for(lambda: "best effort, volatile" in row(wide, "/scan"))
    assert row(wide, "/scan").endswith("10.0 Hz 45.0 kB/s 6 ms")
    assert wide.page.locator(".wv-topic").bounding_box()["height"] == 26  # pyright: ignore[reportOptionalSubscript]
    wide.page.evaluate("localStorage.removeItem('webviz.width')")
    wide.page.set_viewport_size({"width": WIDTH, "height": HEIGHT})


def test_topics_are_found_by_name_and_type(loop: Loop, panel: Tab) -> None:
    show(loop, scan=(SCAN,), map=(MAP,))
    panel.wait_for(lambda: names(panel) == ["/map", "/scan"])
    search = panel.page.get_by_role("searchbox")
    search.fill("OCCUPANCY")
    panel.wait_for(lambda: names(panel) == ["/map"])
    search.fill("nothing like it")
    panel.wait_for(lambda: "No matching topics." in panel.text())
    search.fill("")
    loop.show(offers={})
    panel.wait_for(lambda: "No topic is published." in panel.text())


def test_a_click_on_a_head_sorts_and_another_turns_the_order(loop: Loop, panel: Tab) -> None:
    loop.show(
        offers={"/a": Offer((SCAN,)), "/b": Offer((MAP,)), "/c": Offer((SCAN,))},
        traffic={"/b": Traffic(5.0, 1.0), "/c": Traffic(50.0, 1.0)},
    )
    panel.wait_for(lambda: names(panel) == ["/a", "/b", "/c"])
    panel.button("Rate").click()
    panel.wait_for(lambda: names(panel) == ["/c", "/b", "/a"])
    panel.button("Name").click()
    panel.button("Name").click()
    panel.wait_for(lambda: names(panel) == ["/c", "/b", "/a"])
    heads = panel.page.locator(".wv-head-name")
    assert heads.get_attribute("aria-sort") == "descending"


def test_of_thousands_of_topics_those_in_sight_are_on_the_page(loop: Loop, panel: Tab) -> None:
    loop.show(offers={f"/t{i:04}": Offer((SCAN,)) for i in range(5000)})
    panel.wait_for(lambda: "/t0000" in names(panel))
    assert len(names(panel)) < 60
    panel.page.locator(".wv-topics .wv-rows").evaluate("e => { e.scrollTop = e.scrollHeight }")
    panel.wait_for(lambda: "/t4999" in names(panel))
    assert len(names(panel)) < 60
    panel.page.locator(".wv-topics-table").focus()
    panel.page.keyboard.press("Home")
    panel.wait_for(lambda: "/t0000" in names(panel))


def test_keys_move_through_the_rows_and_enter_looks_into_one(loop: Loop, panel: Tab) -> None:
    show(loop, a=(SCAN,), b=(MAP,))
    panel.wait_for(lambda: names(panel) == ["/a", "/b"])
    panel.page.locator(".wv-topics-table").focus()
    for key in ("ArrowDown", "ArrowDown", "Enter"):
        panel.page.keyboard.press(key)
    panel.wait_for_command(InspectTopics(frozenset({"/b"})))


def test_a_message_is_a_tree_that_can_be_folded(loop: Loop, panel: Tab) -> None:
    show(loop, scan=(SCAN,))
    choose(panel, "/scan")
    panel.wait_for_command(InspectTopics(frozenset({"/scan"})))
    message = to_tree(LaserScan(ranges=np.arange(720, dtype=np.float32)))
    loop.show(inspected={"/scan": Inspected(SCAN.type, message, "", 2912, 1.0)})
    tree = panel.page.get_by_role("tree", name="Last message on /scan")
    panel.wait_for(lambda: "angle_min" in tree.inner_text())
    assert "2.9 kB" in panel.text()
    ranges = tree.get_by_role("treeitem").filter(has_text="ranges")
    assert ranges.get_attribute("aria-expanded") == "false"
    ranges.click()
    panel.wait_for(lambda: "[19]" in tree.inner_text() or "[5]" in tree.inner_text())
    panel.page.keyboard.press("ArrowLeft")
    panel.wait_for(lambda: ranges.get_attribute("aria-expanded") == "false")
    stamp = tree.get_by_role("treeitem").filter(has_text="stamp")
    stamp.click()
    panel.wait_for(lambda: "nanosec:" in tree.inner_text(), 5)


def test_a_message_that_changes_changes_only_its_values(loop: Loop, panel: Tab) -> None:
    show(loop, text=(SCAN,))
    choose(panel, "/text")
    tree = {"fields": {"first": "'one'", "second": "1"}}
    loop.show(inspected={"/text": Inspected("x", tree)})
    values = panel.page.locator(".wv-field-value")
    panel.wait_for(lambda: values.all_inner_texts() == ["'one'", "1"])
    panel.page.evaluate(
        "window.mutated = []; new MutationObserver((all) => mutated.push(...all.map("
        "({ target }) => target.className ?? target.parentElement.className)))"
        ".observe(document.querySelector('.wv-inspected'),"
        "{ subtree: true, childList: true, attributes: true, characterData: true })"
    )
    loop.show(inspected={"/text": Inspected("x", {"fields": {"first": "'one'", "second": "2"}})})
    panel.wait_for(lambda: values.all_inner_texts() == ["'one'", "2"])
    mutated = panel.page.evaluate("mutated")
    assert set(mutated) == {"wv-field-value wv-ellipsis"}
    assert len(mutated) <= 2


def test_why_there_is_no_message_is_said(loop: Loop, panel: Tab) -> None:
    show(loop, text=(SCAN,))
    choose(panel, "/text")
    loop.show(inspected={"/text": Inspected(problem=f"No message has arrived yet. {HOSTILE}")})
    panel.wait_for(lambda: f"No message has arrived yet. {HOSTILE}" in panel.text())


def test_a_panel_that_is_closed_looks_into_nothing(loop: Loop, panel: Tab) -> None:
    show(loop, scan=(SCAN,))
    choose(panel, "/scan")
    panel.wait_for_command(InspectTopics(frozenset({"/scan"})))
    panel.show_tab("Displays")
    panel.wait_for_command(InspectTopics(frozenset()))


def test_a_topic_is_shown_by_the_display_that_fits_or_says_why_not(loop: Loop, panel: Tab) -> None:
    show(loop, imu=(IMU,), cloud=(BOTH,), none=())
    choose(panel, "/imu")
    panel.button("Show").click()
    panel.wait_for(lambda: [each.type for each in loop.commands if isinstance(each, AddDisplay)])
    loop.commands.clear()
    choose(panel, "/none")
    panel.wait_for(lambda: "No publisher." in panel.text())
    assert panel.button("Show").is_disabled()
    choose(panel, "/cloud")
    panel.button("Show").click()
    panel.page.get_by_role("menuitem", name="Boxes").click()
    panel.wait_for(lambda: any(isinstance(each, AddDisplay) for each in loop.commands))
    added = loop.commands[-1]
    assert isinstance(added, AddDisplay)
    assert (added.type, added.values) == ("Boxes", {"source": "/cloud"})
    panel.wait_for(lambda: "Added Boxes for /cloud." in panel.text())


def test_name_and_message_are_copied(loop: Loop, tab: Tab) -> None:
    tab.page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    tab.show_tab("Topics")
    show(loop, scan=(SCAN,))
    choose(tab, "/scan")
    tree = {
        "fields": {
            "header": {"fields": {"frame_id": "'base'"}},
            "ranges": {"length": 720, "type": "float32", "items": ["1", "2"]},
        }
    }
    loop.show(inspected={"/scan": Inspected("x", tree)})
    tab.wait_for(lambda: "ranges" in tab.text())
    tab.button("Copy name").click()
    tab.wait_for(lambda: tab.page.evaluate("navigator.clipboard.readText()") == "/scan")
    tab.button("Copy message").click()
    text = "header:\n  frame_id: 'base'\nranges: [1, 2, …]  # 720 \N{MULTIPLICATION SIGN} float32"
    tab.wait_for(lambda: tab.page.evaluate("navigator.clipboard.readText()") == text)


def test_a_name_that_cannot_be_sent_stops_no_other_store(loop: Loop, panel: Tab) -> None:
    show(loop, scan=(SCAN,))
    choose(panel, "/scan")
    bad = {"/half \ud800": Offer((SCAN,))}
    loop.show(offers=bad, inspected={"/scan": Inspected("x", {"fields": {"a": "still read"}})})
    panel.wait_for(lambda: "still read" in panel.text())


def test_where_publishers_differ_the_qos_is_mixed() -> None:
    offers = {"/scan": Offer((SCAN,)), "/mixed": Offer((SCAN, MAP))}
    made = shown_by("topics", State(offers=offers))
    assert made["/scan"]["qos"] == "best effort, volatile"
    assert made["/mixed"]["qos"] == "mixed, mixed"


def test_hidden_topics_are_listed_when_they_are_asked_for(loop: Loop, tab: Tab) -> None:
    publisher = Publisher("/driver", "std_msgs/msg/String", "reliable", "volatile")
    offer = Offer((publisher,))
    loop.show(offers={"/scan": offer})
    tab.show_tab("Topics")
    grid = tab.page.get_by_role("grid", name="Topics")
    tab.wait_for(grid.get_by_text("/scan").is_visible)
    switch = tab.button("Hidden topics")
    playwright.expect(switch).to_be_hidden()
    loop.show(offers={"/scan": offer, "/dock/_action/status": offer})
    tab.wait_for(switch.is_visible)
    playwright.expect(grid.get_by_text("/dock/_action/status")).to_be_hidden()
    switch.click()
    tab.wait_for(grid.get_by_text("/dock/_action/status").is_visible)
    switch.click()
    playwright.expect(grid.get_by_text("/dock/_action/status")).to_be_hidden()
