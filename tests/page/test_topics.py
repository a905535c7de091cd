"""The panel "Topics"."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

import playwright.sync_api as playwright
import pytest
from page_stores import page_store

from tests.page.page_bench import PageBench
from tests.page.tabs import HEIGHT, WIDTH, ViewerTab
from webviz.api import registry
from webviz.api.declared import Topic
from webviz.api.display import Display, Input
from webviz.commands import AddDisplay
from webviz.engine.state import State
from webviz.shell.testing.messages import header
from webviz.sources import Offer, Publisher
from webviz_displays.laser_scan import LaserScan
from webviz_displays.map import Map

HOSTILE = "<img src=x onerror=alert(1)>"
CLOUD = "test_msgs/msg/Cloud"
DIMENSION = "std_msgs/msg/MultiArrayDimension"
SCAN = Publisher("/driver", "sensor_msgs/msg/LaserScan", "best_effort", "volatile")
MAP = Publisher("/server", "nav_msgs/msg/OccupancyGrid", "reliable", "transient_local")
IMU = Publisher("/imu", "sensor_msgs/msg/Imu", "reliable", "volatile")
BOTH = Publisher("/camera", CLOUD, "reliable", "volatile")
AGE = "wv-topic-age wv-quiet wv-number"
"""Class of the time since a message came, which goes on by itself."""


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
def panel(viewer_tab: ViewerTab) -> Iterator[ViewerTab]:
    """The tab with the panel open."""
    tab = viewer_tab
    tab.show_tab("Topics")
    tab.page.get_by_role("searchbox").fill("")
    yield tab
    tab.page.evaluate("localStorage.removeItem('webviz.topics-sort')")
    tab.show_tab("Displays")


def names(tab: ViewerTab) -> list[str]:
    """The topics that are seen, from top to bottom."""
    return tab.page.locator(".wv-topic .wv-cell-name").all_inner_texts()


def row(tab: ViewerTab, name: str) -> str:
    """Return the text of a row in one line."""
    rows = tab.page.locator(".wv-topic").all_inner_texts()
    lines = [" ".join(text.split()) for text in rows]
    return next((line for line in lines if line.startswith(name)), "")


def choose(tab: ViewerTab, name: str) -> None:
    tab.wait_for(lambda: name in names(tab))
    tab.page.locator(".wv-cell-name").get_by_text(name, exact=True).click()


def show(viewer: PageBench, **publishers: tuple[Publisher, ...]) -> None:
    """Have these topics, and no others."""
    viewer.source.topics = {f"/{name}": Offer(each) for name, each in publishers.items()}


def inspected(viewer: PageBench) -> set[str]:
    """The topics that are looked into."""
    return set(viewer.states[-1].inspected)


def measure_scans(viewer: PageBench) -> None:
    """Show scans of 4.5 kB that come at 10 Hz, 6.1 ms after their stamp."""
    viewer.show(LaserScan(name="Scan"))
    viewer.source.topics["/scan"] = Offer((SCAN,), subscribers=3)
    viewer.turn()
    for _ in range(40):
        viewer.pass_time(0.1)
        stamped = header("map", viewer.source.now - 6_100_000)
        viewer.publish("/scan", SCAN.type, {"header": stamped, "ranges": [1.0] * 1110})
        viewer.turn()


def test_a_topic_has_its_facts_in_a_row(viewer: PageBench, panel: ViewerTab) -> None:
    viewer.source.topics[HOSTILE] = Offer((MAP, MAP), subscribers=0)
    measure_scans(viewer)
    panel.wait_for(lambda: "10.0 Hz" in row(panel, "/scan"))
    scan = row(panel, "/scan")
    assert scan == "/scan sensor_msgs/LaserScan 1 pub 3 subs 10.0 Hz 45.0 kB/s"
    assert "2 pubs 0 subs" in row(panel, HOSTILE)


def test_a_wide_panel_has_all_columns(viewer: PageBench, panel: ViewerTab) -> None:
    wide = panel
    wide.page.evaluate("async () => (await import('webviz/remember.js')).remember('width', 850)")
    wide.page.set_viewport_size({"width": 1310, "height": HEIGHT})
    measure_scans(viewer)
    wide.wait_for(lambda: "best effort, volatile" in row(wide, "/scan"))
    assert row(wide, "/scan").endswith("10.0 Hz 45.0 kB/s 6 ms")
    (height,) = set(
        wide.page.locator(".wv-topic").evaluate_all("all => all.map(e => e.offsetHeight)")
    )
    assert height == 26
    wide.page.evaluate("localStorage.removeItem('webviz.width')")
    wide.page.set_viewport_size({"width": WIDTH, "height": HEIGHT})


def test_topics_are_found_by_name_and_type(viewer: PageBench, panel: ViewerTab) -> None:
    show(viewer, scan=(SCAN,), map=(MAP,))
    panel.wait_for(lambda: names(panel) == ["/map", "/scan"])
    search = panel.page.get_by_role("searchbox")
    search.fill("OCCUPANCY")
    panel.wait_for(lambda: names(panel) == ["/map"])
    search.fill("nothing like it")
    panel.wait_for(lambda: "No matching topics." in panel.text())
    search.fill("")
    show(viewer)
    panel.wait_for(lambda: "No topic is published." in panel.text())


def test_a_click_on_a_head_sorts_and_another_turns_the_order(
    viewer: PageBench, panel: ViewerTab
) -> None:
    show(viewer, a=(SCAN,), b=(MAP,), c=(SCAN,))
    viewer.show(Map(name="b", topic=Topic("/b")), LaserScan(name="c", topic=Topic("/c")))
    viewer.turn()
    for i in range(40):
        viewer.pass_time(0.1)
        viewer.publish("/c", SCAN.type, {})
        if i % 2:
            viewer.publish("/b", MAP.type, {})
        viewer.turn()
    panel.wait_for(lambda: names(panel) == ["/a", "/b", "/c"])
    panel.page.locator(".wv-topics").get_by_role("button", name="Rate").click()
    panel.wait_for(lambda: names(panel) == ["/c", "/b", "/a"])
    panel.button("Name").click()
    panel.button("Name").click()
    panel.wait_for(lambda: names(panel) == ["/c", "/b", "/a"])
    heads = panel.page.locator(".wv-head-name")
    assert heads.get_attribute("aria-sort") == "descending"


def test_of_thousands_of_topics_those_in_sight_are_on_the_page(
    viewer: PageBench, panel: ViewerTab
) -> None:
    show(viewer, **{f"t{i:04}": (SCAN,) for i in range(5000)})
    panel.wait_for(lambda: "/t0000" in names(panel))
    assert len(names(panel)) < 60
    panel.page.locator(".wv-topics .wv-rows").evaluate("e => { e.scrollTop = e.scrollHeight }")
    panel.wait_for(lambda: "/t4999" in names(panel))
    assert len(names(panel)) < 60
    panel.page.locator(".wv-topics-table").focus()
    panel.page.keyboard.press("Home")
    panel.wait_for(lambda: "/t0000" in names(panel))


def test_keys_move_through_the_rows_and_enter_looks_into_one(
    viewer: PageBench, panel: ViewerTab
) -> None:
    show(viewer, a=(SCAN,), b=(MAP,))
    panel.wait_for(lambda: names(panel) == ["/a", "/b"])
    panel.page.locator(".wv-topics-table").focus()
    for key in ("ArrowDown", "ArrowDown", "Enter"):
        panel.page.keyboard.press(key)
    panel.wait_for(lambda: inspected(viewer) == {"/b"})


def test_a_message_is_a_tree_that_can_be_folded(viewer: PageBench, panel: ViewerTab) -> None:
    show(viewer, scan=(SCAN,))
    choose(panel, "/scan")
    panel.wait_for(lambda: inspected(viewer) == {"/scan"})
    viewer.publish("/scan", SCAN.type, {"ranges": list(range(720))})
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


def test_a_message_that_changes_changes_only_its_values(
    viewer: PageBench, panel: ViewerTab
) -> None:
    show(viewer, text=(Publisher("/writer", DIMENSION, "reliable", "volatile"),))
    choose(panel, "/text")
    panel.wait_for(lambda: inspected(viewer) == {"/text"})

    def publish(size: int) -> None:
        viewer.pass_time(1.0)
        viewer.publish("/text", DIMENSION, {"label": "one", "size": size})
        viewer.turn()

    for _ in range(6):  # until the rate stays
        publish(1)
    values = panel.page.locator(".wv-field-value")
    panel.wait_for(lambda: values.all_inner_texts() == ["'one'", "1", "0"])
    panel.wait_for(lambda: "1.0 Hz" in panel.page.locator(".wv-topic-facts").inner_text())
    panel.page.evaluate(
        "window.mutated = []; new MutationObserver((all) => mutated.push(...all.map("
        "({ target }) => target.className ?? target.parentElement.className)))"
        ".observe(document.querySelector('.wv-inspected'),"
        "{ subtree: true, childList: true, attributes: true, characterData: true })"
    )
    publish(2)
    panel.wait_for(lambda: values.all_inner_texts() == ["'one'", "2", "0"])
    mutated = [each for each in panel.page.evaluate("mutated") if each != AGE]
    assert set(mutated) == {"wv-field-value wv-ellipsis"}
    assert len(mutated) <= 2


def test_why_there_is_no_message_is_said(viewer: PageBench, panel: ViewerTab) -> None:
    show(viewer, text=(SCAN,))
    choose(panel, "/text")
    panel.wait_for(lambda: "No message has arrived yet." in panel.text())
    viewer.source.topics["/text"] = Offer((SCAN,), problem=f"its type is unknown {HOSTILE}")
    reason = f"This topic cannot be read: its type is unknown {HOSTILE}."
    panel.wait_for(lambda: reason in panel.text())
    viewer.source.topics["/text"] = Offer(())
    panel.wait_for(lambda: "No publisher on this topic." in panel.text())


def test_a_panel_that_is_closed_looks_into_nothing(viewer: PageBench, panel: ViewerTab) -> None:
    show(viewer, scan=(SCAN,))
    choose(panel, "/scan")
    panel.wait_for(lambda: inspected(viewer) == {"/scan"})
    assert "/scan" in viewer.source.subscriptions
    panel.show_tab("Displays")
    panel.wait_for(lambda: inspected(viewer) == set())
    panel.wait_for(lambda: "/scan" not in viewer.source.subscriptions)


def test_a_topic_is_shown_by_the_display_that_fits_or_says_why_not(
    viewer: PageBench, panel: ViewerTab
) -> None:
    show(viewer, imu=(IMU,), cloud=(BOTH,), none=())
    choose(panel, "/imu")
    panel.button("Show").click()
    panel.wait_for(lambda: [each.type for each in viewer.rows] == ["Imu"])
    assert viewer.values("topic.name") == ["/imu"]
    choose(panel, "/none")
    panel.wait_for(lambda: "No publisher." in panel.text())
    assert panel.button("Show").is_disabled()
    choose(panel, "/cloud")
    panel.button("Show").click()
    panel.page.get_by_role("menuitem", name="Boxes").click()
    panel.wait_for(lambda: [each.type for each in viewer.rows] == ["Imu", "Boxes"])
    assert isinstance(viewer.commands[-1], AddDisplay)
    assert viewer.display_named("Boxes").source.name == "/cloud"
    panel.wait_for(lambda: "Added Boxes for /cloud." in panel.text())


def test_name_and_message_are_copied(viewer: PageBench, viewer_tab: ViewerTab) -> None:
    tab = viewer_tab
    tab.page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    tab.show_tab("Topics")
    show(viewer, scan=(SCAN,))
    choose(tab, "/scan")
    tab.wait_for(lambda: inspected(viewer) == {"/scan"})
    ranges = {"ranges": [1.0, 2.0] * 360}
    viewer.publish("/scan", SCAN.type, {"header": {"frame_id": "base"}, **ranges})
    tab.wait_for(lambda: "ranges" in tab.text())
    tab.button("Copy name").click()
    tab.wait_for(lambda: tab.page.evaluate("navigator.clipboard.readText()") == "/scan")
    tab.button("Copy message").click()
    tab.wait_for(lambda: "angle_min" in tab.page.evaluate("navigator.clipboard.readText()"))
    text = tab.page.evaluate("navigator.clipboard.readText()")
    facts = ("angle_min", "angle_max", "angle_increment", "time_increment", "scan_time")
    assert text.split("\n") == [
        *("header:", "  stamp:", "    sec: 0", "    nanosec: 0", "  frame_id: 'base'"),
        *(f"{each}: 0" for each in (*facts, "range_min", "range_max")),
        f"ranges: [{'1, 2, ' * 10}…]  # 720 \N{MULTIPLICATION SIGN} float32",
        "intensities: []",
    ]


def test_a_name_that_cannot_be_sent_stops_no_other_store(
    viewer: PageBench, panel: ViewerTab
) -> None:
    show(viewer, scan=(SCAN,))
    choose(panel, "/scan")
    panel.wait_for(lambda: inspected(viewer) == {"/scan"})
    viewer.source.topics["/half \ud800"] = Offer((SCAN,))
    viewer.publish("/scan", SCAN.type, {"header": {"frame_id": "still read"}})
    panel.wait_for(lambda: "still read" in panel.text())


def test_where_publishers_differ_the_qos_is_mixed() -> None:
    offers = {"/scan": Offer((SCAN,)), "/mixed": Offer((SCAN, MAP))}
    topics_store = page_store("topics", State(offers=offers))
    assert topics_store["/scan"]["qos"] == "best effort, volatile"
    assert topics_store["/mixed"]["qos"] == "mixed, mixed"


def test_hidden_topics_are_listed_when_they_are_asked_for(
    viewer: PageBench, panel: ViewerTab
) -> None:
    publisher = Publisher("/driver", "std_msgs/msg/String", "reliable", "volatile")
    show(viewer, scan=(publisher,))
    grid = panel.page.get_by_role("grid", name="Topics")
    panel.wait_for(grid.get_by_text("/scan").is_visible)
    switch = panel.button("Hidden topics")
    playwright.expect(switch).to_be_hidden()
    viewer.source.topics["/dock/_action/status"] = Offer((publisher,))
    panel.wait_for(switch.is_visible)
    playwright.expect(grid.get_by_text("/dock/_action/status")).to_be_hidden()
    switch.click()
    panel.wait_for(grid.get_by_text("/dock/_action/status").is_visible)
    switch.click()
    playwright.expect(grid.get_by_text("/dock/_action/status")).to_be_hidden()
