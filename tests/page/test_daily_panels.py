"""The panels of a working day in a real browser: each draws what it was given, and hears clicks."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from typing import Any

import pytest
from pages import bounds

from tests.page.opened_panels import open_panel
from tests.page.page_bench import PageBench, PageServer
from tests.page.tabs import ViewerTab
from webviz.api.declared import make
from webviz.api.panel import Panel
from webviz.commands import Reset
from webviz.data.messages import decode, encode, interfaces
from webviz.panels.diagnostics import ARRAY, MAX_STATUSES, Diagnostics
from webviz.panels.indicator import Indicator
from webviz.panels.log import LOG, Log
from webviz.panels.parameters import Parameters
from webviz.panels.publish import PublishMessage
from webviz.panels.raw import RawMessage
from webviz.panels.state_timeline import StateTimeline
from webviz.panels.table import MessageTable

HOSTILE = "<img src=x onerror=alert(1)>"
SECOND = 10**9


@pytest.fixture
def tab(viewer_tab: ViewerTab) -> Iterator[ViewerTab]:
    yield viewer_tab
    viewer_tab.show_tab("Displays")


def subscribe(tab: ViewerTab, panel: Panel, **topics: str) -> None:
    """Open a panel in its tab, and wait until it has subscribed.

    Args:
        tab: of a browser.
        panel: to open.
        topics: that have a publisher, with their types; their names have no slash here.
    """
    viewer = tab.viewer
    for topic, type_ in topics.items():
        viewer.offer(f"/{topic}", type_, "/robot")
    heads = tab.page.get_by_role("tab", name=panel.name, exact=True)
    tab.wait_for(lambda: heads.count() == 0)  # that of a test before
    open_panel(tab, panel)
    tab.wait_for(lambda: panel.subscriptions().keys() <= viewer.source.subscriptions.keys())


Line = tuple[int, str, str]
"""Level, node and text."""


def log(viewer: PageBench, *lines: Line, times: int = 1) -> None:
    """Have nodes log lines, all of them several times."""
    place = {"file": "drive.cpp", "function": "step", "line": 42}
    encoded = [
        encode(LOG, {"stamp": {"sec": i}, "level": level, "name": name, "msg": text, **place})
        for i, (level, name, text) in enumerate(lines)
    ]
    for _ in range(times):
        for cdr in encoded:
            viewer.source.put("/rosout", LOG, cdr)
        viewer.turn()


def many_lines() -> Sequence[Line]:
    """Return as many lines as a source holds between two turns."""
    levels = 20, 20, 20, 10, 40
    return [(levels[i % 5], f"node_{i % 3}", f"line {i} {HOSTILE}") for i in range(1000)]


def test_the_log_is_filtered_and_opened_and_leads_to_its_time(
    viewer: PageBench, tab: ViewerTab
) -> None:
    viewer.source.now = time.time_ns()
    subscribe(tab, make(Log, {}), rosout=LOG)
    log(viewer, *many_lines(), times=100)
    viewer.source.now = hot_ns = time.time_ns()
    log(viewer, (40, "base", "The motor is hot\nsecond line"))
    newest = tab.page.get_by_role("option").filter(has_text="The motor is hot")
    tab.wait_for(lambda: newest.count() == 1 and newest.is_visible())
    follow = tab.button("Follow the newest line")
    for i in range(3):
        log(viewer, (20, "arm", f"still cold {i}"))
        newer = tab.page.get_by_role("option").filter(has_text=f"still cold {i}")
        tab.wait_for(lambda newer=newer: newer.count() == 1 and newer.is_visible())
        assert follow.get_attribute("aria-pressed") == "true"
    remaining = len(viewer.panel(Log).chunks) * 200
    assert 90_000 < remaining <= 100_000
    width = "(span) => span.clientWidth / span.parentElement.clientWidth"
    share = newest.locator("span").last.evaluate(width)
    assert share > 0.9, "in a narrow panel the text has a line of its own"
    level = tab.page.get_by_role("combobox", name="Lowest level")
    level.fill("Error")
    level.press("Enter")
    tab.page.get_by_label("Node", exact=True).fill("BASE")
    tab.wait_for(lambda: tab.page.get_by_text("1 line", exact=True).count())
    newest.click()
    tab.wait_for(lambda: "drive.cpp:42 step" in tab.text() and "second line" in tab.text())
    tab.button("Go to this time").click()
    tab.wait_for(lambda: viewer.playback.is_live is False)
    hot_s = (hot_ns - viewer.playback.start_ns) / SECOND
    assert viewer.playback.position_s == pytest.approx(hot_s, abs=1e-6)
    tab.page.get_by_label("Node", exact=True).fill("nobody")
    tab.wait_for(lambda: "No line matches these filters." in tab.text())


def test_the_log_follows_again_after_it_began_anew(viewer: PageBench, tab: ViewerTab) -> None:
    subscribe(tab, make(Log, {}), rosout=LOG)
    follow = tab.button("Follow the newest line")
    rows = tab.page.get_by_role("listbox", name="Log")

    def add(what: str, count: int) -> None:
        log(viewer, *((20, "arm", f"{what} {i}") for i in range(count)))
        newest = rows.get_by_role("option").filter(has_text=f"{what} {count - 1}")
        tab.wait_for(lambda: newest.count() == 1 and newest.is_visible())

    def forget() -> None:
        viewer.do(Reset())
        tab.wait_for(lambda: rows.get_by_role("option").count() == 0)
        tab.page.evaluate(SCROLLED)  # the browser scrolls an emptied list

    add("live", 500)
    forget()
    add("past", 3)
    forget()
    add("live again", 500)
    assert follow.get_attribute("aria-pressed") == "true"
    rows.hover()
    tab.page.mouse.wheel(0, -400)
    tab.wait_for(lambda: follow.get_attribute("aria-pressed") == "false")
    log(viewer, (20, "arm", "one more"))
    tab.wait_for(lambda: tab.page.get_by_text("501 lines", exact=True).count() == 1)
    assert follow.get_attribute("aria-pressed") == "false", "somebody reads above"
    forget()
    add("past again", 500)
    assert follow.get_attribute("aria-pressed") == "true"


SCROLLED = """() => new Promise((resolve) => {
  requestAnimationFrame(() => requestAnimationFrame(resolve));
})"""
"""Waits until the page has handled what its lists scroll by."""


def test_diagnostics_are_a_tree_with_the_worst_first(viewer: PageBench, tab: ViewerTab) -> None:
    def report(load: str, count: int = 30) -> None:
        motor = {"name": "base: motor", "level": 2, "message": HOSTILE, "hardware_id": "m1"}
        motor["values"] = [{"key": "load", "value": load}, {"key": "name", "value": HOSTILE}]
        fine = [{"name": f"arm: joint {i}", "message": "fine"} for i in range(count)]
        viewer.publish(
            "/diagnostics", ARRAY, {"status": [*fine, motor, {"name": "laser", "level": 1}]}
        )

    subscribe(tab, make(Diagnostics, {}), diagnostics=ARRAY)
    report("0.5 A")
    rows = tab.page.locator(".wv-diagnostic")
    tab.wait_for(lambda: rows.count() == 4)
    assert [text.split("\n")[0] for text in rows.all_inner_texts()] == [
        "base",
        "motor",
        "laser",
        "arm",
    ]
    assert rows.nth(0).get_attribute("data-level") == "error"
    rows.nth(1).click()
    tab.wait_for(lambda: "0.5 A" in tab.text())
    viewer.pass_time(1.0)
    report("-1e308 A")
    tab.wait_for(lambda: tab.page.get_by_label("2 values").count() == 1)
    viewer.pass_time(97.0)
    tab.wait_for(lambda: rows.nth(0).get_attribute("data-level") == "idle")
    report("1", count=2 * MAX_STATUSES)
    tab.wait_for(lambda: f"the limit is {MAX_STATUSES}" in tab.text())


STATUSES = [{"name": f"s{i}", "level": i % 3, "message": HOSTILE} for i in range(3)]


def test_a_message_is_a_tree(viewer: PageBench, tab: ViewerTab) -> None:
    subscribe(tab, make(RawMessage, {"path": "/diagnostics"}), diagnostics=ARRAY)
    viewer.publish("/diagnostics", ARRAY, {"status": STATUSES})
    tab.wait_for(lambda: tab.page.locator(".wv-field-row").count() > 2)
    field = tab.page.get_by_role("combobox", name="Message path")
    path = "/diagnostics.status[:]{level>0}.name"
    field.fill(path)
    field.press("Enter")
    tab.wait_for(lambda: viewer.panel(RawMessage).path == path)


def test_messages_are_a_table_that_is_sorted(viewer: PageBench, tab: ViewerTab) -> None:
    subscribe(tab, make(MessageTable, {"path": "/diagnostics.status"}), diagnostics=ARRAY)
    viewer.publish("/diagnostics", ARRAY, {"status": STATUSES})
    rows = tab.page.locator(".wv-table-row[aria-rowindex]")
    tab.wait_for(lambda: rows.count() == 3)
    tab.page.get_by_role("columnheader", name="level").click()
    tab.page.get_by_role("columnheader", name="level").click()
    tab.wait_for(lambda: rows.first.inner_text().startswith("ERROR (2)"))


def test_a_value_is_a_lamp(viewer: PageBench, tab: ViewerTab) -> None:
    rules = {"path": "/diagnostics.status[2].level", "rules": ["<1: green", ">=2: red Bad"]}
    subscribe(tab, make(Indicator, rules), diagnostics=ARRAY)
    viewer.publish("/diagnostics", ARRAY, {"status": STATUSES})
    tab.wait_for(lambda: tab.page.get_by_role("img", name="red").count() == 1)
    assert "Bad" in tab.text()


def test_states_are_bands_that_lead_to_their_time(page_server: PageServer, tab: ViewerTab) -> None:
    viewer = page_server.begin(ago_s=30.0)
    paths = ["/diagnostics.status[1].name", "/x"]
    band = make(StateTimeline, {"paths": paths, "window": 40.0})
    viewer.source.now = time.time_ns()
    subscribe(tab, band, diagnostics=ARRAY)
    viewer.publish_past(20.0, "/diagnostics", ARRAY, {"status": STATUSES})
    canvas = tab.page.get_by_role("img", name="/diagnostics.status[1].name")
    tab.wait_for(lambda: "No publisher on /x." in tab.text())
    box = bounds(canvas)
    viewer.source.now = now_ns = time.time_ns()
    canvas.click(position={"x": box["width"] * 0.75, "y": 10})
    tab.wait_for(lambda: viewer.playback.is_live is False)
    sought_s = viewer.playback.position_s - (now_ns - viewer.playback.start_ns) / SECOND
    assert sought_s == pytest.approx(-band.window / 4, abs=band.window / 6)


PARAMETERS = "rcl_interfaces/srv"


def answer(viewer: PageBench, **responses: Any) -> None:
    """Have the node /base answer services with these values, by the name of their type."""
    for name, values in responses.items():
        service = {"List": "list", "Describe": "describe", "Get": "get", "Set": "set"}[name]
        cdr = encode(interfaces.service(f"{PARAMETERS}/{name}Parameters").response, values)
        viewer.graph.responses[f"/base/{service}_parameters"] = cdr


def parameters_set(viewer: PageBench) -> list[Any]:
    """The changes that the node /base was asked for, as name, type and value."""
    requests = [
        decode(interfaces.service(f"{PARAMETERS}/SetParameters").request, cdr)
        for service, _, cdr in viewer.graph.requests
        if service == "/base/set_parameters"
    ]
    return [
        (each.name, each.value.bool_value if each.value.type == 1 else each.value.double_value)
        for request in requests
        for each in request.parameters
    ]


def test_a_parameter_is_set_by_enter(page_server: PageServer, tab: ViewerTab) -> None:
    viewer = page_server.begin(allow_publish=("/base/set_parameters",))
    names = ["on", *(f"speed_{i}" for i in range(300))]
    about = {"description": HOSTILE, "floating_point_range": [{"from_value": 0, "to_value": 2}]}
    on, speed = {"type": 1, "bool_value": True}, {"type": 3, "double_value": 0.5}
    values = [on, *(speed for _ in names[1:])]
    answer(
        viewer,
        List={"result": {"names": names}},
        Describe={"descriptors": [{"name": name, **about} for name in names]},
        Get={"values": values},
        Set={"results": [{"successful": True}]},
    )
    panel = make(Parameters, {"node": "/base", "editable": ["/base"]})
    subscribe(tab, panel, parameter_events="rcl_interfaces/msg/ParameterEvent")
    field = tab.page.get_by_role("textbox", name="speed_1", exact=True)
    tab.wait_for(lambda: field.count() == 1)
    assert "double · 0 to 2 · " in tab.text()
    values[0] = {"type": 1, "bool_value": False}
    answer(viewer, Get={"values": values})
    box = tab.page.get_by_role("checkbox", name="on", exact=True)
    box.uncheck()
    tab.wait_for(lambda: parameters_set(viewer) == [("on", False)])
    answer(viewer, Set={"results": [{"reason": "Too fast."}]})
    field.fill("1e3")
    field.press("Enter")
    tab.wait_for(lambda: parameters_set(viewer)[1:] == [("speed_1", 1000.0)])
    tab.wait_for(lambda: "Too fast." in tab.text())
    assert field.input_value() == "1e3", "somebody may correct it"
    field.blur()
    assert field.input_value() == "0.5"
    field.fill("7")
    field.press("Escape")
    assert field.input_value() == "0.5"
    assert not box.is_checked()


def test_a_form_publishes_what_was_entered(page_server: PageServer, tab: ViewerTab) -> None:
    viewer = page_server.begin(allow_publish=("/name",))
    panel = make(PublishMessage, {"topic": "/name", "presets": {"greeting": "data: hello"}})
    subscribe(tab, panel, name="std_msgs/msg/String")
    field = tab.page.get_by_role("textbox", name="data", exact=True)
    tab.wait_for(lambda: field.count() == 1)
    tab.button("History and presets").click()
    tab.page.get_by_role("menuitem", name="greeting").click()
    yaml = tab.page.get_by_label("YAML")
    tab.wait_for(lambda: yaml.input_value() == "data: hello")
    field.fill(HOSTILE)
    field.press("Enter")
    tab.wait_for(lambda: HOSTILE in yaml.input_value())
    yaml.fill("data: 5")
    yaml.blur()
    tab.wait_for(lambda: "expected text" in tab.text())
    tab.button("Publish").click()
    toast = tab.page.locator(".wv-toast")
    tab.wait_for(lambda: toast.count() and "expected text" in toast.first.inner_text())
    assert "failed" not in toast.first.inner_text(), "the panel is fine; the value is not"
    field.fill(f"{HOSTILE}!")
    field.press("Enter")
    tab.wait_for(lambda: f"{HOSTILE}!" in yaml.input_value())
    tab.button("Publish").click()
    tab.wait_for(viewer.published)
    ((topic, message),) = viewer.published()
    assert (topic, message.data) == ("/name", f"{HOSTILE}!")
