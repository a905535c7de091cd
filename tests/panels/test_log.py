"""The panel Log without a browser: what it keeps, and for how long."""

from __future__ import annotations

from typing import Any

import pytest

from tests.support.panel_facts import show as show_panel
from webviz.api.errors import Error
from webviz.data.messages import decode, encode
from webviz.engine.state import State
from webviz.page.recorded_ui import RecordedUi
from webviz.page.widgets import CustomWidget
from webviz.panels import log as module
from webviz.panels.log import LOG, ROS_1_LOG, Log
from webviz.sources import Offer, Publisher


@pytest.fixture
def log() -> Log:
    """The panel, built."""
    panel = Log()
    panel.ui = RecordedUi()  # type: ignore[attr-defined]
    panel.build(panel.ui, lambda *_: None)  # type: ignore[attr-defined]
    return panel


def widget(log: Any) -> CustomWidget:
    return log.ui.widgets["0"]


def texts(log: Log) -> list[str]:
    show_panel(log, State())
    first, end = widget(log).values["values"]["chunks"]
    parts = [widget(log).parts[str(number)] for number in range(first, end)]
    return [text for part in parts for text in part["texts"]]


def test_lines_are_kept_in_order_and_closed_chunks_are_not_sent_again(log: Log) -> None:
    for i in range(450):
        log.add((0.0, 20, "node", str(i), ""), i)
    assert texts(log) == [str(i) for i in range(450)]
    before = widget(log).parts
    log.add((0.0, 20, "node", "450", ""), 450)
    assert texts(log)[-1] == "450"
    changed = [key for key, part in widget(log).parts.items() if before.get(key) is not part]
    assert changed == ["2"]


def test_neither_many_nor_long_lines_fill_the_memory(
    log: Log, monkeypatch: pytest.MonkeyPatch
) -> None:
    log.lines = 1000
    for i in range(5000):
        log.add((0.0, 20, "node", str(i), ""), i)
    assert 1000 <= len(texts(log)) < 1400
    assert texts(log)[-1] == "4999"
    monkeypatch.setattr(module, "MAX_CHARACTERS", 1_000_000)
    for _ in range(1000):
        values = {"msg": "x" * 100_000, "name": "n" * 1000, "file": "\x1b" * 500}
        log.take("/rosout", decode(LOG, encode(LOG, values)), 0)
    assert sum(map(len, texts(log))) < 1_100_000
    assert "\x1b" not in str([*widget(log).parts.values()][-1]["places"])


def test_a_log_of_ros_1_has_the_levels_of_ros_2(log: Log) -> None:
    offer = Offer((Publisher("/node", ROS_1_LOG, "reliable", "volatile"),))
    show_panel(log, State(offers={"/rosout": offer}))
    assert log.subscriptions() == {"/rosout": ROS_1_LOG}


def test_a_time_is_sought_only_in_a_recording(log: Log) -> None:
    log.add((0.0, 20, "node", "text", ""), 5)
    show_panel(log, State())
    with pytest.raises(Error, match="There is no recording to seek in"):
        log.use([0, 0], 1)


def test_no_publisher_is_named(log: Log) -> None:
    show_panel(log, State())
    values = widget(log).values["values"]
    assert values["problem"].startswith("No publisher on /rosout.")
    assert values["total"] == 0
