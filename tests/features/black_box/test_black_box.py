"""Rules that save the last minute when they hold."""

from __future__ import annotations

import re
import shutil
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import closing
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from bench import Bench, Benches, benches

from webviz.api.status import Level
from webviz.commands import Refresh
from webviz.data.messages import decode, encode
from webviz.data.recordings import open_recording
from webviz.data.recordings.folder_writing import RecordingFolder
from webviz.engine.state import State
from webviz.features import black_box
from webviz.features.black_box.observation import (
    DIAGNOSTICS,
    LOG,
    SPAN_S,
    TopicObserver,
    WatchedMoment,
)
from webviz.features.black_box.rules import REARM_S, RuleWatcher
from webviz.files.config import ConfigError, WatchLimits, WatchRule, dump
from webviz.files.opening import parse
from webviz.sources import Offer, Publisher, Raw
from webviz_displays.path import Path as PathDisplay

PATH = "nav_msgs/msg/Path"
JOINTS = "sensor_msgs/msg/JointState"
PUBLISHER = Publisher("/planner", PATH, "reliable", "volatile")
SCAN = WatchRule(display="Scan", status="error", lasting="2s")


def fired(watcher: RuleWatcher, levels: dict[float, Level | None]) -> list[float]:
    """Return when a rule about the display Scan fires, given its levels by time."""
    results = []
    for at_s, level in levels.items():
        displays = {} if level is None else {"Scan": level}
        results += [at_s for _ in watcher.fired(WatchedMoment(at_s, displays))]
    return results


def test_a_rule_fires_after_the_duration_of_its_condition() -> None:
    levels = {0: Level.OK, 1: Level.ERROR, 2: Level.WARN, 3: Level.ERROR, 4: Level.ERROR}
    assert fired(RuleWatcher([SCAN]), {**levels, 5: Level.ERROR, 6: Level.ERROR}) == [5]
    warn = WatchRule(display="Scan", status="warn", lasting="2s")
    assert fired(RuleWatcher([warn]), {**levels, 5: Level.OK}) == [3]


def test_a_rule_that_flaps_fires_once() -> None:
    every: dict[float, Level | None] = {
        at_s: Level.ERROR if at_s % 20 < 10 else Level.OK for at_s in range(200)
    }
    watcher = RuleWatcher([SCAN])
    assert fired(watcher, every) == [2]
    clear: dict[float, Level | None] = {200: Level.OK, 200 + REARM_S: Level.OK, 240: Level.ERROR}
    assert fired(watcher, {**clear, 242: Level.ERROR}) == [242]


def test_an_unknown_status_neither_fires_nor_clears_a_rule() -> None:
    watcher = RuleWatcher([SCAN])
    assert fired(watcher, {0: Level.ERROR, 2: Level.ERROR}) == [2]
    assert fired(watcher, dict.fromkeys(range(3, 90))) == []
    assert fired(watcher, {90: Level.ERROR, 92: Level.ERROR}) == []


def test_a_number_of_a_message_path_fires_a_rule() -> None:
    battery = WatchRule(path="/battery.level[motor].@abs", value="<0.2")
    joints = WatchRule(path="/joints.position[left].@derivative", value=">= 5")
    observer, watcher = TopicObserver(), RuleWatcher([battery, joints])

    def send(at_s: float, *values: float, name: str = "left") -> list[str]:
        for i, value in enumerate(values):
            message = encode(JOINTS, {"name": [name], "position": [value]})
            observer.put("/joints", Raw(message, round((at_s + i / 100) * 1e9), at_s))
        moment = WatchedMoment(at_s, numbers=observer.numbers())
        return [rule.title for rule in watcher.fired(moment)]

    observer.observe(["/joints"], {}, {joints.path: JOINTS})
    assert send(0.0) == []
    assert send(1.0, 1.0, 1.01) == []
    assert send(2.0, 99.0, name="right") == []
    observer.put("/joints", Raw(b"\0\1\0\0", 0, 0.0))
    assert send(3.0, 1.0, 1.5, 1.5) == ["/joints.position[left].@derivative >= 5"]
    assert send(4.0, *[1.0] * 1000) == []  # of many, the last count
    assert battery.watched_topic == "/battery"
    observer.observe([], {}, {})
    assert observer.numbers() == {}


def test_rates_are_known_after_some_seconds_and_fall_with_silence() -> None:
    observer = TopicObserver()
    observer.observe(["/scan"], {})
    for tenths in range(40):
        observer.put("/scan", Raw(b"", 0, tenths / 10))
        observer.put("/other", Raw(b"", 0, tenths / 10))
    assert observer.rates(2.9) == {}
    assert observer.rates(4.0) == {"/scan": pytest.approx(10, abs=0.5)}
    assert observer.rates(60.0) == {"/scan": 0}
    slow = RuleWatcher([WatchRule(topic="/scan", rate="<5"), WatchRule(topic="/scan", rate="> 5")])
    assert [rule.rate for rule in slow.fired(WatchedMoment(4.0, rates={"/scan": 10.0}))] == ["> 5"]
    assert [rule.rate for rule in slow.fired(WatchedMoment(9.0, rates={"/scan": 0.0}))] == ["<5"]


@pytest.mark.parametrize(
    ("type_name", "values", "level"),
    [
        (DIAGNOSTICS, {"status": [{"level": 0}, {"level": 2}]}, Level.ERROR),
        (DIAGNOSTICS, {"status": [{"level": 1}]}, Level.WARN),
        (DIAGNOSTICS, {"status": [{"level": 3}]}, Level.ERROR),
        (DIAGNOSTICS, {}, Level.OK),
        (LOG, {"level": 40}, Level.ERROR),
        (LOG, {"level": 30}, Level.WARN),
        (LOG, {"level": 20}, Level.OK),
    ],
)
def test_levels_are_those_of_messages(type_name: str, values: dict[str, Any], level: Level) -> None:
    observer = TopicObserver()
    observer.observe([], {"/log": type_name})
    observer.put("/log", Raw(encode(type_name, values), 0, 10.0))
    observer.put("/log", Raw(b"\1\2", 0, 10.1))
    assert observer.levels(11.0) == {"/log": level}
    observer.observe([], {"/log": type_name})
    assert observer.levels(11.0) == {"/log": level}
    assert observer.levels(20.0) == {"/log": Level.OK}
    observer.observe([], {})
    assert observer.levels(20.0) == {}


@pytest.mark.parametrize(
    ("rule", "reason"),
    [
        ("{display: Scan}", "watch[0]: a rule is one condition. Write {rule: Scan.walls > 0.8}"),
        ("{topic: /a, rate: '<5', level: warn}", "watch[0]: a rule is one condition."),
        ("{rule: Scan.walls > 0.8, for: 2s}", "watch[0]: a rule is one condition."),
        ("{rule: Scan.wals > 0.8}", "watch[0]: `Scan.wals > 0.8`: unknown value wals. Use status,"),
        ("{topic: /a, rate: '5'}", "watch[0]: rate `5` is not a condition. Write it like"),
        ("{topic: /a, rate: '<5', for: soon}", "watch[0]: for `soon` is not a duration."),
        ("{path: /a.x}", "watch[0]: a rule is one condition."),
        ("{path: /a.x, value: '<1', topic: /a}", "watch[0]: a rule is one condition."),
        ("{path: /a.x, value: low}", "watch[0]: value `low` is not a condition. Write it like"),
        ("{path: /a, value: '<1'}", "watch[0]: path `/a` has no field. Add one, such as .data."),
        ("{path: '/a.x[', value: '<1'}", "watch[0]: path: "),
        ("{display: Scan, status: bad}", "watch[0].status: expected warn or error, got `bad`."),
        ("{display: Scan, state: error}", "watch[0].state: unknown key"),
    ],
)
def test_a_bad_rule_is_an_error_with_file_line_and_key(rule: str, reason: str) -> None:
    with pytest.raises(ConfigError) as excinfo:
        parse(f"version: 1\nwatch:\n- {rule}\n", "lab.yaml")
    assert str(excinfo.value).startswith(f"lab.yaml:3: {reason}")


def test_rules_are_saved_as_they_were_written() -> None:
    text = "watch:\n- {display: Scan, status: error, for: 2s}\n- {topic: /scan, rate: <5}\n"
    assert text in dump(parse(text, "lab.yaml"))


@pytest.fixture
def make(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Benches]:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(black_box, "AFTER_S", 0.2)
    monkeypatch.setattr(black_box, "SETTLE_S", 0.0)
    with benches() as make_bench:

        def make(*rules: WatchRule, per_day: int = 20, gigabytes: float = 5.0) -> Bench:
            bench = make_bench(PathDisplay(name="Plan"))
            bench.viewer.settings.watch = rules
            bench.viewer.settings.watch_limits = WatchLimits(per_day, gigabytes)
            bench.source.topics["/path"] = Offer((PUBLISHER,), type=PATH)
            bench.turn()
            return bench

        yield make


def publish(bench: Bench, x: float) -> None:
    pose = {"header": {"frame_id": "map"}, "pose": {"position": {"x": x}}}
    bench.publish("/path", PATH, {"header": {"frame_id": "map"}, "poses": [pose]})


def until(bench: Bench, is_reached: Callable[[State], bool]) -> State:
    """Turn until a state."""
    for _ in range(1000):
        if is_reached(state := bench.do(Refresh())):
            return state
        bench.clock += 0.1  # the doctor looks once a second
        time.sleep(0.01)
    raise AssertionError("not reached")


def causes(bench: Bench) -> set[str]:
    """Return why something is being saved in the next 5 s of the doctor."""
    results = set[str]()
    for _ in range(50):
        state = bench.do(Refresh()).black_box
        results |= {state.saving} if state is not None else set()
        bench.clock += 0.1
        time.sleep(0.01)
    return results


def fail(bench: Bench) -> None:
    """Let the display fail: its publisher has another type."""
    bench.source.topics["/path"] = Offer((PUBLISHER,), problem="its type differs", type=PATH)


def is_saving(state: State) -> bool:
    """Return whether a recording is being made."""
    return state.black_box is not None and bool(state.black_box.saving)


def messages(path: Path) -> list[bytes]:
    """The messages of a recording."""
    with closing(open_recording(path)) as recording:
        assert recording.span_ns
        return [m.data for m in recording.messages(recording.channels, *recording.span_ns)]


def recording_files(bench: Bench) -> list[Path]:
    """The recordings once none is being made."""

    def is_done(state: State) -> bool:
        box = state.black_box
        return box is not None and bool(box.saved) and not box.saving

    outcome = until(bench, is_done).black_box
    return [each.path for each in outcome.saved] if outcome else []


def test_a_rule_saves_messages_before_and_after_it_fires(make: Benches) -> None:
    bench = make(WatchRule(display="Plan", status="error"))
    publish(bench, 1.0)
    publish(bench, 2.0)
    fail(bench)
    until(bench, is_saving)
    publish(bench, 3.0)
    (path,) = recording_files(bench)
    assert path.parent.name == "webviz_black_box"
    assert path.name.startswith(f"{datetime.now():%Y-%m-%d}_")
    assert path.name.endswith("_Plan_error")
    assert len(messages(path)) == 3


def test_a_rule_that_fires_as_the_viewer_ends_saves_earlier_messages(
    make: Benches, monkeypatch: pytest.MonkeyPatch
) -> None:
    goes_on, make_folder = threading.Event(), black_box.new_folder

    def slow(path: Path) -> RecordingFolder:
        assert goes_on.wait(20)
        return make_folder(path)

    monkeypatch.setattr(black_box, "new_folder", slow)
    bench = make(WatchRule(display="Plan", status="error"))
    publish(bench, 1.0)
    publish(bench, 2.0)
    fail(bench)
    until(bench, is_saving)
    goes_on.set()
    bench.viewer.close()
    (path,) = Path("webviz_black_box").iterdir()
    assert len(messages(path)) == 2


def test_a_violated_condition_saves_earlier_messages(make: Benches) -> None:
    bench = make(WatchRule(rule="Plan.status < error"))
    publish(bench, 1.0)
    fail(bench)
    bench.clock += 2.0  # for another round of the doctor
    (path,) = recording_files(bench)
    assert path.name.endswith("_Plan_status_error")


def test_no_more_is_saved_than_the_limits_allow(make: Benches) -> None:
    bench = make(WatchRule(display="Plan", status="error"), per_day=0)
    publish(bench, 1.0)
    fail(bench)
    statuses = until(bench, lambda state: "Black box" in state.statuses).statuses
    assert statuses["Black box"].text == (
        "A rule fired, but 0 recordings were made today, which is the limit. Raise "
        "watch_limits.per_day."
    )
    assert not Path("webviz_black_box").exists()


@pytest.mark.parametrize(
    ("per_day", "gigabytes", "reason"),
    [
        (2, 5.0, "2 recordings were made today"),
        (3, 0.0015, "webviz_black_box has 0.0 GB, which is the limit"),
    ],
)
def test_recordings_that_were_made_before_count(
    make: Benches, per_day: int, gigabytes: float, reason: str
) -> None:
    for days, cause in ((0, "a"), (0, "b"), (1, "c"), (2, "d")):
        moment = datetime.now() - timedelta(days=days)
        path = Path("webviz_black_box") / f"{moment:{black_box.MOMENT}}_{cause}"
        path.mkdir(parents=True)
        (path / "metadata.yaml").write_bytes(bytes(400_000))
    bench = make(WatchRule(display="Plan", status="error"), per_day=per_day, gigabytes=gigabytes)
    publish(bench, 1.0)
    until(bench, lambda state: state.black_box is not None and len(state.black_box.saved) == 4)
    store = bench.viewer.get(black_box.BlackBoxFeature).black_box("")
    assert store is not None
    assert [megabytes for _, megabytes, *_ in store.saved] == [0.4] * 4
    fail(bench)
    statuses = until(bench, lambda state: "Black box" in state.statuses).statuses
    assert statuses["Black box"].text.startswith(f"A rule fired, but {reason}")


def test_a_rule_saves_until_its_time_is_up(make: Benches, monkeypatch: pytest.MonkeyPatch) -> None:
    bench = make(WatchRule(display="Plan", status="error"))
    monkeypatch.setattr(black_box, "AFTER_S", 1e9)
    publish(bench, 1.0)
    fail(bench)
    until(bench, lambda _: any(Path("webviz_black_box").glob("*/*.mcap")))
    assert causes(bench) == {"Plan error"}


@pytest.mark.parametrize(
    "rule", [WatchRule(display="Plan", status="warn"), WatchRule(rule="Plan.status < warn")]
)
def test_a_display_that_has_received_nothing_yet_fires_no_rule(
    make: Benches, rule: WatchRule
) -> None:
    bench = make(rule)
    fail(bench)
    for _ in range(10):
        assert bench.do(Refresh()).rows[0].level >= Level.WARN
        bench.clock += 1.0  # for another round of the doctor
    bench.source.topics["/path"] = Offer((PUBLISHER,), type=PATH)
    bench.turn()
    assert not Path("webviz_black_box").exists()
    publish(bench, 1.0)
    fail(bench)
    recording_files(bench)


def test_a_status_does_not_count_while_a_robot_starts(
    make: Benches, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(black_box, "SETTLE_S", 1e9)
    bench = make(WatchRule(display="Plan", status="error"))
    publish(bench, 1.0)
    fail(bench)
    until(bench, lambda state: state.rows[0].level is Level.ERROR)
    assert causes(bench) == {""}
    assert not Path("webviz_black_box").exists()
    monkeypatch.setattr(black_box, "SETTLE_S", 0.0)
    recording_files(bench)


def test_a_recording_stays_below_the_limit(make: Benches) -> None:
    bench = make(WatchRule(display="Plan", status="error"), gigabytes=0.0001)
    for x in range(10):
        noise = np.random.default_rng(x).bytes(15_000).hex()[:15_000]
        bench.publish("/path", PATH, {"header": {"frame_id": f"{x} {noise}"}})
    fail(bench)
    until(bench, is_saving)
    for _ in range(10):
        bench.publish("/path", PATH, {"header": {"frame_id": "x" * 15_000}})
    (path,) = recording_files(bench)
    assert sum(file.stat().st_size for file in path.iterdir()) < 100_000
    paths = [decode(PATH, cdr) for cdr in messages(path)]
    assert paths[-1].header.frame_id.startswith("9 "), "those before the fault go first"
    assert 4 <= len(paths) <= 6
    assert bench.do(Refresh()).statuses["Black box"].text.startswith("The last recording was cut")


def test_a_disk_that_is_nearly_full_is_not_filled(
    make: Benches, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(black_box, "RESERVE", shutil.disk_usage(Path.cwd()).free + 10**9)
    bench = make(WatchRule(display="Plan", status="error"))
    publish(bench, 1.0)
    fail(bench)
    statuses = until(bench, lambda state: "Black box" in state.statuses).statuses
    assert re.fullmatch(
        r"A rule fired, but its disk has \d+\.\d GB left\. Make room, so that it can go on\.",
        statuses["Black box"].text,
    )
    assert not Path("webviz_black_box").exists()


def test_a_driver_that_crashes_fires_a_rule_about_its_rate(make: Benches) -> None:
    bench = make(WatchRule(topic="/path", rate="<5"))
    bench.do(Refresh())
    began_s = time.monotonic() - SPAN_S
    for tenths in range(round(SPAN_S * 10)):
        bench.source.inbox.put("/path", Raw(b"", 0, began_s + tenths / 10))
    bench.turn()
    del bench.source.topics["/path"]
    (path,) = recording_files(bench)
    assert path.name.endswith("_path_rate_5")
    assert len(messages(path)) == 30


def test_a_recording_that_was_cut_off_is_listed(make: Benches) -> None:
    bench = make(WatchRule(display="Plan", status="error"))
    publish(bench, 1.0)
    fail(bench)
    (path,) = recording_files(bench)
    (path / "metadata.yaml").unlink()
    bench.viewer.settings.watch = (WatchRule(topic="/none", rate="<1"),)
    bench.do(Refresh())
    assert recording_files(bench) == [path]


def test_a_rule_about_a_missing_display_has_a_status(make: Benches) -> None:
    bench = make(WatchRule(display="Plam", status="error"))
    bench.do(Refresh())
    text = bench.do(Refresh()).statuses["Black box"].text
    assert text.startswith("A rule watches the display `Plam`, which does not exist.")
