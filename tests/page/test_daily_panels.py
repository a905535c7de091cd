"""The panels of a working day in a real browser: each draws what it was given, and hears clicks."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from tests.page.conftest import Loop, Tab
from webviz.api.declared import make
from webviz.api.panel import Panel
from webviz.commands import CallService, Publish, Seek, SetPanelProperty
from webviz.data.messages import decode, encode
from webviz.engine.state import PanelTab, PanelTimes
from webviz.panels.diagnostics import ARRAY, MAX_STATUSES, Diagnostics
from webviz.panels.indicator import Indicator
from webviz.panels.log import LOG, Log
from webviz.panels.parameters import Parameters
from webviz.panels.publish import PublishMessage
from webviz.panels.raw import RawMessage
from webviz.panels.state_timeline import StateTimeline
from webviz.panels.table import MessageTable
from webviz.sources import Offer, Publisher
from webviz.sources.past_state import PlaybackState

HOSTILE = "<img src=x onerror=alert(1)>"
SECOND = 10**9


@pytest.fixture(autouse=True)
def _close(loop: Loop, tab: Tab) -> Iterator[None]:
    yield
    loop.show(panels=(), offers={}, playback=None)
    tab.show_tab("Displays")


def message(type_: str, **values: Any) -> Any:
    """A message as it is received."""
    return decode(type_, encode(type_, values))


def offered(**types: str) -> dict[str, Offer]:
    """Publishers by topic, whose names have no slash here."""
    return {
        f"/{topic}": Offer((Publisher("/robot", type_, "reliable", "volatile"),))
        for topic, type_ in types.items()
    }


def open_panel(loop: Loop, tab: Tab, panel: Panel, **changes: Any) -> None:
    """Open a panel in its tab, with these changes of the viewer's state."""
    name = type(panel).__name__
    heads = tab.page.get_by_role("tab", name=panel.name, exact=True)
    tab.wait_for(lambda: heads.count() == 0)  # that of a test before
    loop.show(panels=(PanelTab(f"of {name}", name, panel),), **changes)
    tab.wait_for(lambda: heads.count() == 1)
    tab.show_tab(panel.name)
    tab.wait_for(lambda: tab.page.locator(".wv-plugin-widgets > *").count() > 0)


def log_line(level: int, name: str, text: str, at_s: int) -> Any:
    place = {"file": "drive.cpp", "function": "step", "line": 42}
    return message(LOG, stamp={"sec": at_s}, level=level, name=name, msg=text, **place)


def test_the_log_is_filtered_and_opened_and_leads_to_its_time(loop: Loop, tab: Tab) -> None:
    log = make(Log, {})
    for i in range(100_000):
        level = (20, 20, 20, 10, 40)[i % 5]
        log.add((float(i), level, f"node_{i % 3}", f"line {i} {HOSTILE}", "a.py:1 f"), i * SECOND)
    log.take("/rosout", log_line(40, "base", "The motor is hot\nsecond line", 5), 7 * SECOND)
    open_panel(loop, tab, log, offers=offered(rosout=LOG), playback=recorded())
    newest = tab.page.get_by_role("option").filter(has_text="The motor is hot")
    tab.wait_for(lambda: newest.count() == 1 and newest.is_visible())
    follow = tab.button("Follow the newest line")
    for i in range(3):
        log.add((float(i), 20, "arm", f"still cold {i}", ""), 8 * SECOND)
        newer = tab.page.get_by_role("option").filter(has_text=f"still cold {i}")
        tab.wait_for(lambda newer=newer: newer.count() == 1 and newer.is_visible())
        assert follow.get_attribute("aria-pressed") == "true"
    remaining = len(log.chunks) * 200
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
    tab.wait_for_command(Seek(7.0))
    tab.page.get_by_label("Node", exact=True).fill("nobody")
    tab.wait_for(lambda: "No line matches these filters." in tab.text())


def test_the_log_follows_again_after_it_began_anew(loop: Loop, tab: Tab) -> None:
    log = make(Log, {})
    open_panel(loop, tab, log, offers=offered(rosout=LOG), playback=recorded())
    follow = tab.button("Follow the newest line")
    rows = tab.page.get_by_role("listbox", name="Log")

    def add(what: str, count: int) -> None:
        for i in range(count):
            log.add((float(i), 20, "arm", f"{what} {i}", ""), i * SECOND)
        newest = rows.get_by_role("option").filter(has_text=f"{what} {count - 1}")
        tab.wait_for(lambda: newest.count() == 1 and newest.is_visible())

    def forget() -> None:
        log.start_over()
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
    log.add((0.0, 20, "arm", "one more", ""), 0)
    tab.wait_for(lambda: tab.page.get_by_text("501 lines", exact=True).count() == 1)
    assert follow.get_attribute("aria-pressed") == "false", "somebody reads above"
    forget()
    add("past again", 500)
    assert follow.get_attribute("aria-pressed") == "true"


SCROLLED = """() => new Promise((resolve) => {
  requestAnimationFrame(() => requestAnimationFrame(resolve));
})"""
"""Waits until the page has handled what its lists scroll by."""


def recorded() -> PlaybackState:
    """A bag of a million seconds."""
    return PlaybackState(
        names=("run",),
        start_ns=0,
        end_ns=10**6 * SECOND,
        position_s=0.0,
        rate=1.0,
        is_playing=False,
        is_seeking=False,
        loop=False,
        selected=None,
    )


def test_diagnostics_are_a_tree_with_the_worst_first(loop: Loop, tab: Tab) -> None:
    panel = make(Diagnostics, {})

    def report(at_s: int, load: str, count: int = 30) -> None:
        motor = {"name": "base: motor", "level": 2, "message": HOSTILE, "hardware_id": "m1"}
        motor["values"] = [{"key": "load", "value": load}, {"key": "name", "value": HOSTILE}]
        fine = [{"name": f"arm: joint {i}", "message": "fine"} for i in range(count)]
        array = message(ARRAY, status=[*fine, motor, {"name": "laser", "level": 1}])
        panel.take("/diagnostics", array, at_s * SECOND)

    report(1, "0.5 A")
    offers = offered(diagnostics=ARRAY)
    open_panel(loop, tab, panel, offers=offers, clock=PanelTimes(ros_ns=2 * SECOND))
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
    report(2, "-1e308 A")
    loop.show(offers=offers, clock=PanelTimes(ros_ns=2 * SECOND))
    tab.wait_for(lambda: tab.page.get_by_label("2 values").count() == 1)
    loop.show(offers=offers, clock=PanelTimes(ros_ns=99 * SECOND))
    tab.wait_for(lambda: rows.nth(0).get_attribute("data-level") == "idle")
    report(99, "1", count=2 * MAX_STATUSES)
    tab.wait_for(lambda: f"the limit is {MAX_STATUSES}" in tab.text())


def test_a_message_is_a_tree_a_table_a_lamp_and_a_band(loop: Loop, tab: Tab) -> None:
    statuses = [{"name": f"s{i}", "level": i % 3, "message": HOSTILE} for i in range(3)]
    array = message(ARRAY, status=statuses)
    offers = offered(diagnostics=ARRAY)
    raw, table = (
        make(RawMessage, {"path": "/diagnostics"}),
        make(MessageTable, {"path": "/diagnostics.status"}),
    )
    lamp = make(
        Indicator, {"path": "/diagnostics.status[2].level", "rules": ["<1: green", ">=2: red Bad"]}
    )
    band = make(StateTimeline, {"paths": ["/diagnostics.status[1].name", "/x"]})
    panels: list[Panel] = [raw, table, lamp, band]
    for panel in panels:
        open_panel(loop, tab, panel, offers=offers, clock=PanelTimes(ros_ns=100 * SECOND))
        tab.wait_for(lambda panel=panel: "/diagnostics" in panel.subscriptions())
        panel.take("/diagnostics", array, *([90 * SECOND] if panel is band else []))
        if panel is raw:
            tab.wait_for(lambda: tab.page.locator(".wv-field-row").count() > 2)
            field = tab.page.get_by_role("combobox", name="Message path")
            field.fill("/diagnostics.status[:]{level>0}.name")
            field.press("Enter")
            tab.wait_for_command(SetPanelProperty("of RawMessage", "path", field.input_value()))
        elif panel is table:
            rows = tab.page.locator(".wv-table-row[aria-rowindex]")
            tab.wait_for(lambda rows=rows: rows.count() == 3)
            tab.page.get_by_role("columnheader", name="level").click()
            tab.page.get_by_role("columnheader", name="level").click()
            tab.wait_for(lambda rows=rows: rows.first.inner_text().startswith("ERROR (2)"))
        elif panel is lamp:
            tab.wait_for(lambda: tab.page.get_by_role("img", name="red").count() == 1)
            assert "Bad" in tab.text()
        else:
            canvas = tab.page.get_by_role("img", name="/diagnostics.status[1].name")
            tab.wait_for(lambda: "No publisher on /x." in tab.text())
            loop.show(panels=loop.state.panels, offers=offers, playback=recorded())
            box = canvas.bounding_box()
            assert box is not None
            canvas.click(position={"x": box["width"] * 0.75, "y": 10})
            tab.wait_for(lambda: isinstance(loop.commands[-1], Seek))
            (seek,) = loop.commands[-1:]
            assert isinstance(seek, Seek)
            assert 80 < seek.at_s < 90


def calls(loop: Loop) -> list[CallService]:
    """The services that were called."""
    return [each for each in loop.commands if isinstance(each, CallService)]


def test_a_parameter_is_set_by_enter(loop: Loop, tab: Tab) -> None:
    panel = make(Parameters, {"node": "/base"})
    open_panel(
        loop, tab, panel, offers=offered(parameter_events="rcl_interfaces/msg/ParameterEvent")
    )
    tab.wait_for(lambda: calls(loop)[-1:])
    assert calls(loop)[-1].service == "/base/list_parameters"
    row = {"range": "0 to 2", "about": HOSTILE, "locked": False}
    panel.known = {"on": {"kind": 1, "value": True, **row}}
    panel.known |= {f"speed_{i}": {"kind": 3, "value": 0.5, **row} for i in range(300)}
    field = tab.page.get_by_role("textbox", name="speed_1", exact=True)
    tab.wait_for(lambda: field.count() == 1)
    assert "double · 0 to 2 · " in tab.text()
    tab.page.get_by_role("checkbox", name="on", exact=True).uncheck()
    tab.wait_for(lambda: calls(loop)[-1].service == "/base/set_parameters")
    value = {"type": 1, "bool_value": False}
    assert calls(loop)[-1].request == {"parameters": [{"name": "on", "value": value}]}
    field.fill("1e3")
    field.press("Enter")
    value = {"type": 3, "double_value": 1000.0}
    entered = {"parameters": [{"name": "speed_1", "value": value}]}
    tab.wait_for(lambda: calls(loop)[-1].request == entered)
    panel.refused = {"speed_1": "Too fast."}
    tab.wait_for(lambda: "Too fast." in tab.text())
    assert field.input_value() == "1e3", "somebody may correct it"
    field.blur()
    assert field.input_value() == "0.5"
    field.fill("7")
    field.press("Escape")
    assert field.input_value() == "0.5"


def test_a_form_publishes_what_was_entered(loop: Loop, tab: Tab) -> None:
    panel = make(PublishMessage, {"topic": "/name", "presets": {"greeting": "data: hello"}})
    open_panel(loop, tab, panel, topics={"/name": ("std_msgs/msg/String",)})
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
    tab.wait_for(lambda: any(isinstance(each, Publish) for each in loop.commands))
    assert [each.values for each in loop.commands if isinstance(each, Publish)] == [
        {"data": f"{HOSTILE}!"}
    ]
