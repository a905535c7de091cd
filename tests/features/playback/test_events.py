"""Warnings and errors on the timeline: of /rosout, and of displays."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from bags import START_NS, Bag, ns, strings
from page_stores import page_store
from rosbags.rosbag2 import StoragePlugin

from webviz.api.status import LOADING, Level, Status
from webviz.commands import RemoveDisplay, Seek
from webviz.data.messages import encode
from webviz.engine.state import Row
from webviz.features.playback import DisplayEvents
from webviz.sources.bag.log import MAX_EVENTS, MAX_NAME, MAX_TEXT, read_log
from webviz.sources.past_state import Event

LOG = "rcl_interfaces/msg/Log"
INFO, WARN, ERROR, FATAL = 20, 30, 40, 50


def logged(*entries: tuple[float, int, str]) -> Bag:
    """A bag with messages on /rosout: (seconds from the start, level, text)."""
    bag = strings(0, 10)
    bag.add("/rosout", LOG)
    for at_s, level, text in entries:
        bag.put(at_s, "/rosout", {"level": level, "name": "driver", "msg": text})
    return bag


@pytest.mark.parametrize("storage", [StoragePlugin.MCAP, StoragePlugin.SQLITE3])
def test_a_worker_reads_warnings_of_rosout(
    tmp_path: Path, theater: Callable, storage: StoragePlugin
) -> None:
    bag = logged((1, INFO, "up"), (2, WARN, "slow\nat line 7"), (3, ERROR, "lost"), (4, FATAL, ""))
    viewer = theater(bag.write(tmp_path / "run", storage))
    viewer.turn_until(lambda: bool(viewer.loop.state().logged))
    state = viewer.loop.state()
    assert list(state.logged) == [
        Event(START_NS + ns(2), Level.WARN, "driver", "slow"),
        Event(START_NS + ns(3), Level.ERROR, "driver", "lost"),
        Event(START_NS + ns(4), Level.ERROR, "driver", ""),
    ]
    assert viewer.loop.state().logged is state.logged
    assert page_store("events", state)["logged"][0] == [2.0, "warn", "driver: slow"]


def test_over_the_limit_the_most_severe_events_and_a_sample_of_the_others_are_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz.sources.bag.log.PATIENCE_S", 600.0)  # of a busy machine
    count = 20 * MAX_EVENTS
    warning = encode(LOG, {"level": WARN, "name": "driver", "msg": "slow"})
    bag = logged((0.5, ERROR, "first"), (9.5, FATAL, "last"))
    bag.messages += [(1 + 8 * i / count, "/rosout", warning) for i in range(count)]
    log = read_log([bag.write(tmp_path / "run")])
    assert len(log.events) == MAX_EVENTS
    assert [e.text for e in log.events if e.level is Level.ERROR] == ["first", "last"]
    late = [e for e in log.events if e.at_ns > START_NS + ns(5)]
    assert len(late) == pytest.approx(MAX_EVENTS / 2, rel=0.2)
    assert not log.warning


def test_any_bytes_on_rosout_are_bounded_and_skipped(tmp_path: Path) -> None:
    bag = logged((1, WARN, "x" * 1_000_000), (2, WARN, "\n" * 1_000_000), (3, ERROR, "a\r\x1b[31m"))
    whole = encode(LOG, {"level": ERROR, "name": "n" * 1_000_000, "msg": "long name"})
    for number, cdr in enumerate((b"", b"\0\1\0\0", whole[:13], whole[:40], b"\xff" * 99, whole)):
        bag.put(4 + number, "/rosout", cdr)
    log = read_log([bag.write(tmp_path / "run")])
    texts = [event.text for event in log.events]
    assert texts == ["x" * (MAX_TEXT - 1) + "…", "", "a\r\x1b[31m", "long name"]
    assert len(log.events[-1].name) == MAX_NAME


def test_a_log_that_is_too_large_is_reported(
    theater: Callable, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz.sources.bag.log.MAX_BYTES", 500)
    viewer = theater(logged((1, WARN, "seen"), (2.5, WARN, "x" * 500), (3, WARN, "not seen")))
    viewer.turn_until(lambda: "Bag" in viewer.loop.state().statuses)
    state = viewer.loop.state()
    assert "only up to 2.5 s" in state.statuses["Bag"].text
    assert [event.text for event in state.logged] == ["seen"]


def test_a_display_that_begins_to_warn_is_noted_and_forgotten_with_it(theater: Callable) -> None:
    bag = Bag()
    bag.add("/scan", "sensor_msgs/msg/LaserScan")
    header: dict[str, Any] = {"frame_id": "map", "stamp": {"sec": START_NS // 10**9}}
    good = {"header": header, "angle_increment": 0.1, "range_max": 10.0, "ranges": [1.0]}
    bag.put(0, "/scan", good)
    bag.put(0.5, "/scan", b"broken")
    bag.put(4, "/scan", good)
    viewer = theater(bag, "displays: [{type: LaserScan, topic: /scan}]\n")
    viewer.do(Seek(0.0))
    assert not viewer.loop.state().warned
    state = viewer.do(Seek(0.5))
    (event,) = state.warned
    assert (event.at_ns, event.name) == (START_NS + ns(0.5), "LaserScan")
    assert event.level >= Level.WARN
    state = viewer.do(RemoveDisplay(state.rows[0].id))
    assert not state.warned


def row(
    level: Level, text: str = "Bad.", id: str = "1", type: str = "Scan", key: str = "Topic"
) -> Row:
    return Row(id, type, None, "Scan", {key: Status(level, text)})


def test_loading_is_not_an_event() -> None:
    events = DisplayEvents()
    events.note(0, [row(Level.OK)])
    events.note(ns(1), [row(Level.WARN, "Loading.", key=LOADING)])
    assert not events.events
    events.note(ns(2), [row(Level.ERROR, "The file does not exist.")])
    assert [event.text for event in events.events] == ["The file does not exist."]


def test_a_rising_level_is_noted_once_per_sentence_and_second() -> None:
    events = DisplayEvents()
    for at_s, level, text in [
        (0.0, Level.WARN, "Wrong from the start."),
        (0.1, Level.OK, "Fine."),
        (1.0, Level.WARN, "Slow."),
        (1.1, Level.WARN, "Slower."),  # the level stays
        (1.2, Level.OK, "Fine."),
        (1.3, Level.WARN, "Slow."),  # noted in this second
        (1.4, Level.ERROR, "Lost."),
        (1.5, Level.IDLE, "Not received."),
        (2.3, Level.WARN, "Slow."),
    ]:
        events.note(ns(at_s), [row(level, text), row(level, text, "g", "Group")])
    assert [(event.at_ns / 1e9, event.text) for event in events.events] == [
        (1.0, "Slow."),
        (1.4, "Lost."),
        (2.3, "Slow."),
    ]
    before = events.events
    events.note(ns(3), [row(Level.WARN)])
    assert events.events is before
    events.note(ns(3), [])
    assert not events.events


def test_notes_are_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("webviz.features.playback.MAX_EVENTS", 3)
    events = DisplayEvents()
    for second in range(10):
        events.note(ns(second), [row(Level.OK)])
        events.note(ns(second + 0.5), [row(Level.WARN)])
    assert [event.at_ns / 1e9 for event in events.events] == [7.5, 8.5, 9.5]
