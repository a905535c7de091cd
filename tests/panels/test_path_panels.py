"""Panels that show message paths: tables, lamps, bands and trees, without a browser."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from tests.support.panel_facts import show as show_panel
from webviz.data.messages import JointState, LaserScan, String, message_class
from webviz.engine.state import PanelTimes, State
from webviz.page.recorded_ui import RecordedUi
from webviz.page.widgets import CustomWidget
from webviz.panels.diagnostics import MAX_STATUSES, Diagnostics
from webviz.panels.indicator import Indicator, judged, parse
from webviz.panels.raw import RawMessage
from webviz.panels.state_timeline import MAX_CHANGES, StateTimeline
from webviz.panels.table import MAX_CHARACTERS, MAX_COLUMNS, MAX_ROWS, MessageTable, table_of
from webviz.sources import Offer, Publisher

SECOND = 10**9
STATUS = message_class("diagnostic_msgs/msg/DiagnosticStatus")
ARRAY = message_class("diagnostic_msgs/msg/DiagnosticArray")
KEY = message_class("diagnostic_msgs/msg/KeyValue")


def built(panel: Any) -> Any:
    """A panel that has shown a viewer with one topic."""
    ui = RecordedUi()
    panel.build(ui, lambda *_: None)
    customs = [each for each in ui.widgets.values() if isinstance(each, CustomWidget)]
    heads = ("own path", "own fields")
    panel.own = next(each for each in customs if each.values["kind"] not in heads)
    return update(panel)


def update(panel: Any, ros_ns: int = 100 * SECOND) -> Any:
    offer = Offer((Publisher("/node", "std_msgs/msg/String", "reliable", "volatile"),))
    show_panel(panel, State(offers={"/t": offer}, clock=PanelTimes(ros_ns=ros_ns)))
    return panel


def values(panel: Any) -> Any:
    return panel.own.values["values"]


def test_rows_of_a_table_are_elements_and_its_columns_their_fields() -> None:
    status = [STATUS(name="a", level=2), STATUS(name="b", message="\x1b[31m" + "x" * 999)]
    table = table_of([status])
    assert table["columns"] == ["level", "name", "message", "hardware_id", "values"]
    assert table["rows"][0] == ["ERROR (2)", "a", "", "", "0 elements"]
    assert len(table["rows"][1][2]) == 200
    assert table_of([np.array([[1.0, math.nan]])])["columns"] == ["x", "y"]
    assert table_of([np.array([1e308, math.inf])])["rows"] == [[1e308], ["inf"]]
    assert table_of([JointState()])["columns"][0] == "header.stamp"
    assert table_of([]) == {"columns": [], "rows": [], "note": ""}


def test_a_large_table_is_shortened_with_a_note() -> None:
    scan = LaserScan(ranges=np.ones(100_000, np.float32))
    table = table_of([scan.ranges])
    assert len(table["rows"]) == MAX_ROWS
    assert table["note"] == f"{100_000 - MAX_ROWS} rows more."
    wide = [STATUS(name="n" * 200, message="m" * 200, hardware_id="h" * 200)] * MAX_ROWS
    assert sum(len(str(row)) for row in table_of([wide])["rows"]) < 2 * MAX_CHARACTERS
    assert len(table_of([np.ones((1, 4))])["columns"]) <= MAX_COLUMNS


@pytest.mark.parametrize(
    ("value", "color", "label"),
    [
        (5, "red", "Low"),
        (20, "green", "20"),
        (math.nan, "grey", "nan"),
        (1e308, "green", "1e+308"),
        ("IDLE", "blue", "Idle: all"),
        ("<b>", "grey", "<b>"),
        (True, "red", "Low"),
    ],
)
def test_the_first_rule_that_fits_chooses_the_lamp(value: Any, color: str, label: str) -> None:
    texts = ("< 20: red Low", ">=20:green", "== 'IDLE': blue Idle: all")
    rules = [rule for text in texts if not isinstance(rule := parse(text), str)]
    assert len(rules) == 3
    assert judged(value, rules) == (color, label)


@pytest.mark.parametrize("text", ["", "20: red", "< 20 red", "< 20: pink", "x" * 10_000])
def test_a_rule_that_cannot_be_read_is_named(text: str) -> None:
    panel = built(Indicator(path="/t.data", rules=[text]))
    panel.take("/t", String("IDLE"))
    assert "is not a rule" in values(update(panel))["problem"]


@pytest.mark.parametrize("kind", [RawMessage, MessageTable, Indicator])
@pytest.mark.parametrize(
    ("path", "problem"),
    [
        ("", "Choose a topic."),
        ("t.data", "has no topic"),
        ("/other.data", "No publisher on /other."),
        ("/t.data", "No message yet."),
    ],
)
def test_a_path_without_values_has_a_reason(kind: type, path: str, problem: str) -> None:
    assert problem in values(built(kind(path=path)))["problem"]


def test_a_field_that_is_missing_is_named_and_a_new_path_starts_over() -> None:
    panel = built(RawMessage(path="/t.text"))
    assert panel.subscriptions() == {"/t": "std_msgs/msg/String"}
    panel.take("/t", String("x" * 100_000))
    assert "No field `text`" in values(update(panel))["problem"]
    panel.path = "/t"
    assert values(update(panel))["tree"] is None
    panel.take("/t", String("x" * 100_000))
    assert len(values(update(panel))["tree"]["fields"]["data"]) < 1000
    panel.refuse("/t", "Not a String.")
    assert values(update(panel))["problem"] == "Not a String."


def test_a_band_has_only_changes_and_a_bounded_number() -> None:
    panel = built(StateTimeline(paths=["/t.data"], window=50.0))
    for i in range(10):
        panel.take("/t", String("idle" if i < 5 else "go"), (90 + i) * SECOND)
    (track,) = values(update(panel))["tracks"]
    assert (track["times"], track["states"]) == ([90.0, 95.0], ["idle", "go"])
    assert values(update(panel, 200 * SECOND))["tracks"][0]["states"] == ["go"]
    for i in range(3 * MAX_CHANGES):
        panel.take("/t", String(f"{i}" * 100), 200 * SECOND + i)
    (track,) = values(update(panel, 200 * SECOND))["tracks"]
    assert len(track["states"]) == MAX_CHANGES
    panel.take("/t", String("back"), 5 * SECOND)
    assert values(update(panel, 6 * SECOND))["tracks"][0]["times"] == [5.0]


def test_bands_are_added_by_topic_and_field_and_removed() -> None:
    panel, commands = StateTimeline(paths=["/t.data"]), list[Any]()
    panel.build(RecordedUi(), lambda command, browser=None: commands.append(command))
    panel.chooser.topic = "/t"
    update(panel)
    assert set(panel.subscriptions()) == {"/t"}
    panel.take("/t", STATUS(values=[KEY(key="a")]), SECOND)
    ui = RecordedUi()
    panel.chooser.build(ui, "band")
    update(panel)
    chooser = ui.widgets["0"]
    offered = ["level", "name", "message", "hardware_id", "values[0].key", "values[0].value"]
    assert chooser.values["values"]["fields"] == offered
    chooser.use('{"add": "/t.name"}', 1)
    panel.use("/t.data", 1)
    assert [each.value for each in commands] == [["/t.data", "/t.name"], []]
    for useless in ('{"add": 5}', "{}", "[]", "7", '{"topic": ["/t"]}'):
        chooser.use(useless, 1)
    assert len(commands) == 2
    chooser.use('{"topic": ""}', 1)
    update(panel)
    assert chooser.values["values"]["fields"] == []


def test_diagnostics_are_bounded_and_grow_stale() -> None:
    panel = built(Diagnostics())
    status = [STATUS(name=f"n: {i}", level=255, message="m" * 9999) for i in range(10**5)]
    status[0] = STATUS(name="n: 0", values=[KEY(key="\x00" * 500, value="\\" * 9999)] * 1000)
    panel.take("/diagnostics", ARRAY(status=status), 99 * SECOND)
    update(panel)
    results = [each for part in panel.own.parts.values() for each in part["statuses"]]
    assert len(results) == MAX_STATUSES
    assert results[1]["path"] == ["/diagnostics", "n", "1"]
    assert (results[0]["level"], results[1]["level"]) == (0, 3)
    assert "not shown; the limit is" in values(panel)["problem"]
    before = dict(panel.own.parts)
    panel.take("/diagnostics", ARRAY(status=[STATUS(name="n: 25")]), 100 * SECOND)
    update(panel)
    assert [key for key, part in panel.own.parts.items() if before[key] is not part] == ["1"]
    update(panel, 999 * SECOND)
    results = [each for part in panel.own.parts.values() for each in part["statuses"]]
    assert {each["level"] for each in results} == {3}
    panel.take("/diagnostics_agg", ARRAY(status=[STATUS(name="/Robot/Arm//x")]), SECOND)
    panel.start_over()
    panel.take("/diagnostics_agg", ARRAY(status=[STATUS(name="/Robot/Arm//x")]), SECOND)
    assert next(iter(panel.devices.values())).row["path"] == [
        "/diagnostics_agg",
        "Robot",
        "Arm",
        "x",
    ]


def test_states_and_raw_values_have_the_names_of_constants() -> None:
    battery = message_class("sensor_msgs/msg/BatteryState")
    bands = built(StateTimeline(paths=["/t.power_supply_status"]))
    bands.take("/t", battery(power_supply_status=2), 99 * SECOND)
    bands.take("/t", battery(power_supply_status=77), 100 * SECOND)
    [track] = values(update(bands))["tracks"]
    assert track["states"] == ["DISCHARGING (2)", "77"]
    raw = built(RawMessage(path="/t.power_supply_status"))
    raw.take("/t", battery(power_supply_status=4))
    assert values(update(raw))["tree"] == {"fields": {"value": "FULL (4)"}}
