"""All that a bug report says of a moment, made of a state that is given."""

from __future__ import annotations

import contextlib
import json
import re
import zipfile
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest
from msgspec.structs import replace

from tests.support.stand_in import stand_in
from webviz.api.errors import Error
from webviz.api.finding import Finding, Severity
from webviz.api.offer import Offer, Publisher
from webviz.api.status import Level, Status
from webviz.data.messages import decode, defined, encode
from webviz.data.recordings import RecordedChannel, open_recording
from webviz.engine.commands import NodePicks
from webviz.engine.state import Row, State
from webviz.features.doctor import DoctorFeature
from webviz.features.reports import ReportedThing, reported_store
from webviz.features.reports.writing import (
    MAX_MOMENTS,
    ReportMoment,
    listing,
    namespaces,
    picked,
    write,
)
from webviz.files.config import Config
from webviz.files.report import BugReport, PrivateNames, ReportedPick, read_report
from webviz.sources.past_state import Event
from webviz.sources.slices import SliceMessage

STRING = "std_msgs/msg/String"
START_NS = 1_700_000_000_000_000_000
OK, WARN = Status(Level.OK, "All is well"), Status(Level.WARN, "alice lost it")


class TextSlice:
    """Two texts, two and a half seconds apart; the second is shown."""

    topics = 1
    seconds = 2.5

    def messages(self) -> Iterator[SliceMessage]:
        channel = RecordedChannel("/words", STRING, "cdr", "string data\n", "")
        for at_s, text in ((0.0, "of alicexyz"), (2.5, "last")):
            yield channel, START_NS + round(at_s * 1e9), encode(STRING, {"data": text})

    def at_ns(self) -> int:
        return START_NS + 2_500_000_000


def row(name: str, type_: str = "Path", **statuses: Status) -> Row:
    return Row(name.lower(), type_, None, name, statuses)


def publisher(node: str, type_: str = STRING) -> Publisher:
    return Publisher(node, type_, "reliable", "transient_local")


STATE = State(
    rows=(row("Group", "Group", Inside=OK), row("Plan", Map=WARN, Topic=OK)),
    statuses={"Bag": OK},
    offers={
        "/words": Offer(
            (publisher("/ns/talker"), publisher("/a")), ("reliable", "volatile"), "late"
        ),
        "/scan": Offer((publisher("", "sensor_msgs/msg/LaserScan"),), subscribers=3),
    },
)


def moment(
    state: State = STATE,
    *,
    warned: Sequence[Event] = (),
    with_names: bool = False,
    source: str = "run",
) -> ReportMoment:
    names = PrivateNames(state.offers, () if with_names else ("alice", "alicexyz"), "/root")
    return ReportMoment(
        TextSlice(),
        source,
        state.rows,
        state.statuses,
        state.offers,
        state.logged,
        warned,
        Config(),
        "map\n",
        len(state.frames),
        (),
        names,
        with_names,
    )


def doctor(*findings: Finding, events: Sequence[Event] = ()) -> DoctorFeature:
    return stand_in(DoctorFeature, findings=findings, events=events)


NO_FINDINGS = doctor()


@pytest.fixture
def write_report(tmp_path: Path) -> Callable[..., BugReport]:
    """Write a report, and read it."""

    def write_report(content: ReportMoment, later: DoctorFeature = NO_FINDINGS) -> BugReport:
        (folder := tmp_path / "read").mkdir()
        path = tmp_path / "bug.zip"
        size = write(path, content, later, None)
        assert size == path.stat().st_size
        assert {each.name for each in tmp_path.iterdir()} == {"read", "bug.zip"}
        return read_report(path, folder).report

    return write_report


def test_the_statuses_have_the_times_at_which_they_began(
    write_report: Callable[..., BugReport],
) -> None:
    times = START_NS + 10**9, START_NS + 2 * 10**9
    warned = [Event(at_ns, Level.WARN, "Plan", "alice lost it") for at_ns in times]
    report = write_report(moment(warned=warned, with_names=True))
    assert [(each.display, each.status, each.level, each.text) for each in report.statuses] == [
        ("", "Bag", "ok", "All is well"),
        ("Plan", "Map", "warn", "alice lost it"),
        ("Plan", "Topic", "ok", "All is well"),
    ]
    assert [each.since for each in report.statuses] == [0.0, START_NS / 1e9 + 1, 0.0]


def test_the_findings_are_the_last_ones_with_their_times(
    write_report: Callable[..., BugReport],
) -> None:
    finding = Finding(
        id="TF001",
        cause="It is off.",
        remedy="Turn it.",
        subject="base",
        severity=Severity.ERROR,
        first_ns=START_NS,
        last_ns=START_NS + 1_500_000_000,
    )
    report = write_report(moment(), doctor(finding))
    (entry,) = report.findings
    assert (entry.id, entry.severity, entry.subject) == ("TF001", "error", "base")
    assert (entry.cause, entry.remedy) == ("It is off.", "Turn it.")
    assert (entry.first, entry.last) == (START_NS / 1e9, START_NS / 1e9 + 1.5)


def test_the_newest_500_moments_are_in_it_by_time(write_report: Callable[..., BugReport]) -> None:
    def events(name: str, first: int, count: int) -> list[Event]:
        return [
            Event(START_NS + number * 10**9, Level.ERROR, name, f"{number}")
            for number in range(first, first + count)
        ]

    state = replace(STATE, logged=events("driver", 0, 300))
    warned = events("Plan", 100, 250)
    report = write_report(moment(state, warned=warned), doctor(events=events("TF001", 349, 1)))
    texts = [int(each.text) for each in report.moments]
    assert len(texts) == MAX_MOMENTS == 500
    assert texts == sorted(texts)
    assert texts[-1] == 349
    first = report.moments[0]
    assert (first.name, first.level, first.at) == ("driver", "error", START_NS / 1e9 + 51)
    assert {each.name for each in report.moments[-2:]} == {"Plan", "TF001"}


def test_a_report_names_its_source_times_and_versions(
    write_report: Callable[..., BugReport], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ROS_DISTRO", "jazzy")
    monkeypatch.delenv("RMW_IMPLEMENTATION", raising=False)
    report = write_report(moment())
    assert report.source == "run"
    assert not report.has_names
    assert report.made > 1.7e9
    assert (report.first_ns, report.last_ns) == (START_NS, START_NS + 2_500_000_000)
    assert report.at_ns == report.last_ns
    assert report.versions["ROS_DISTRO"] == "jazzy"
    assert "RMW_IMPLEMENTATION" not in report.versions
    for program in ("python", "ros-webviz", "numpy"):
        assert re.match(r"\d+\.\d+", report.versions[program])


@pytest.mark.parametrize("with_names", [False, True])
def test_names_of_people_are_in_no_member_unless_included_on_request(
    tmp_path: Path, with_names: bool
) -> None:
    path = tmp_path / "bug.zip"
    write(path, moment(with_names=with_names), NO_FINDINGS, ("picture.png", b"alice"))
    with zipfile.ZipFile(path) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    assert members.pop("picture.png") == b"alice", "a picture stays as it is"
    assert members["frames.txt"] == b"map\n"
    has_names = {name for name, data in members.items() if b"alice" in data}
    assert has_names == ({"report.json"} if with_names else set())
    with contextlib.closing(open_recording(read_report(path, tmp_path).bag)) as recording:
        first, _ = recording.messages(recording.channels, START_NS, START_NS + 3 * 10**9)
    assert decode(STRING, first.data).data == "of " + ("alicexyz" if with_names else "x" * 8)


def test_the_log_is_read_by_the_definition_of_the_slice(tmp_path: Path) -> None:
    log, text = "rcl_interfaces/msg/Log", "uint8 level\nstring msg\nstring name\n"
    entry = {"level": 40, "name": "driver", "msg": "It is hot."}

    class LogSlice(TextSlice):
        def messages(self) -> Iterator[SliceMessage]:
            channel = RecordedChannel("/rosout", log, "cdr", text, "")
            yield channel, START_NS, encode(log, entry, defined(log, text))

    write(tmp_path / "bug.zip", replace(moment(), part=LogSlice()), NO_FINDINGS, None)
    with zipfile.ZipFile(tmp_path / "bug.zip") as archive:
        line = archive.read("log.txt").decode()
    assert line == "2023-11-14T22:13:20.000+00:00 ERROR driver: It is hot.\n"


def test_the_graph_has_topics_with_the_qos_of_their_publishers(tmp_path: Path) -> None:
    path = tmp_path / "bug.zip"
    write(path, moment(), NO_FINDINGS, None)
    with zipfile.ZipFile(path) as archive:
        graph: dict[str, Any] = json.loads(archive.read("graph.json"))
    assert graph["nodes"] == ["/a", "/ns/talker"]
    scan, words = graph["topics"]
    assert (scan["topic"], scan["subscribers"], scan["problem"]) == ("/scan", 3, "")
    assert (words["topic"], words["types"]) == ("/words", [STRING])
    assert (words["requested"], words["problem"]) == (["reliable", "volatile"], "late")
    assert words["publishers"][0] == {
        "node": "/ns/talker",
        "type": STRING,
        "reliability": "reliable",
        "durability": "transient_local",
    }


def test_namespaces_are_those_of_nodes() -> None:
    assert namespaces(STATE.offers) == {"/ns", ""}


def test_the_list_gives_the_amount_of_each_member() -> None:
    lines = listing(moment())
    assert lines[0] == "slice.mcap: 2.5 s of 1 topic from the bag, latched messages first"
    assert "from memory" in listing(moment(source="live"))[0]
    assert lines[1].startswith("config.yaml: 0 displays")
    assert lines[3].startswith("report.json: 4 statuses")
    assert "graph.json: nodes, 2 topics, types and QoS" in lines
    assert lines[-1] == "Names of hosts, users and home folders are left out."
    assert listing(moment(with_names=True))[-1].endswith("home folders are included.")
    state = replace(STATE, offers={"/alice/words": STATE.offers["/words"]})
    assert "left out except alice, of topics or frames." in listing(moment(state))[-1]


def test_a_selection_is_found_by_the_number_of_its_display() -> None:
    item = (5, 7, (1.0, 2.0, 3.0), (9, 8, 7))
    picks = NodePicks("plan/poses/0", "k", (item, item)), NodePicks("gone/poses", "k", (item,))
    result = ReportedPick(1, "poses/0", "k", 7, (1.0, 2.0, 3.0), (9, 8, 7))
    assert picked(picks, STATE.rows) == (result, result)
    things = reported_store(picked(picks[:1], STATE.rows), STATE.rows)
    assert things is not None
    assert things.things[0] == ReportedThing("plan", "k", 7, (1.0, 2.0, 3.0))


@pytest.mark.parametrize(("display", "is_shown"), [(0, True), (1, True), (2, False), (3, False)])
def test_a_reported_selection_is_shown_only_with_its_display(display: int, is_shown: bool) -> None:
    pick = ReportedPick(display, "poses/0", "k", 7, (1.0, 2.0, 3.0))
    assert (reported_store([pick], STATE.rows) is not None) is is_shown


def test_a_report_that_cannot_be_written_is_one_sentence(tmp_path: Path) -> None:
    with pytest.raises(Error, match=r"Cannot write .*bug.zip: No such file .* another place\.$"):
        write(tmp_path / "none" / "bug.zip", moment(), NO_FINDINGS, None)
