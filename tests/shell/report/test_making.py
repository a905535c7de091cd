"""Bug reports of bags: what they contain, and that they show the same again."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path

import playwright.sync_api as playwright
import pytest
import stories
from bags import START_NS, TF, Bag, Topic, ns, stamped

from webviz.api.errors import Error
from webviz.commands import Seek
from webviz.files.opening import load, parse
from webviz.files.report import UnpackedReport, read_report
from webviz.shell.cli import main as cli
from webviz.shell.doctor.examination import examine_bag
from webviz.shell.pictures.headless_renderer import HeadlessRenderer
from webviz.shell.pictures.times import TimeError
from webviz.shell.report.making import make_report
from webviz.shell.report.scenes import Pictured
from webviz.shell.testing import BagViewer, header
from webviz.shell.testing.seeking import plain
from webviz.sources.bag.history import BagHistory
from webviz.sources.player import Player

HOME = "/home/alice"
AT_S = 5.0
COVARIANCE = [0.01 * (i % 7 == 0) for i in range(36)]


@pytest.fixture(scope="module")
def bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("bags")
    return stories.write(folder / "turned", "turned", {3.0: f"cannot open {HOME}/laser.yaml"})


@pytest.fixture(scope="module")
def archive(bag: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("reports") / "bug.zip"
    with open_bag(bag) as source:
        config = parse(stories.CONFIG, "the config")
        span = (2.0, "end")
        make_report(config, source, Pictured(None), path, span=span, at=AT_S, name="turned")
    return path


@pytest.fixture
def report(archive: Path, tmp_path: Path) -> UnpackedReport:
    return read_report(archive, tmp_path)


@contextlib.contextmanager
def open_bag(bag: Path) -> Iterator[Player]:
    with contextlib.closing(Player(BagHistory(bag))) as source:
        yield source


def test_a_report_equals_the_bag_at_its_moment(bag: Path, report: UnpackedReport) -> None:
    with (
        contextlib.closing(BagViewer(bag, stories.CONFIG)) as before,
        contextlib.closing(BagViewer(report.bag, load(report.config))) as after,
    ):
        before.do(Seek(AT_S))
        after.do(Seek(report.report.at_s))
        first, second = (
            list(map(plain, each.visible_nodes().values())) for each in (before, after)
        )
        assert first == second
        assert after.source.history.end_ns - after.source.history.start_ns == pytest.approx(
            4e9, abs=1e8
        )


def test_statuses_and_findings_of_the_moment(report: UnpackedReport) -> None:
    (status,) = [
        each for each in report.report.statuses if each.status == "Map" and each.display == "Scan"
    ]
    assert status.level == "warn"
    assert "rotating 'base_scan' by -18°" in status.text
    assert [each.id for each in report.report.findings] == ["DATA001"]
    assert {each.name for each in report.report.moments} >= {"DATA001", "driver"}


def test_names_are_left_out_of_messages_and_log(archive: Path, report: UnpackedReport) -> None:
    assert HOME.encode() not in report.bag.read_bytes()
    moments = [each.text for each in report.report.moments if each.name == "driver"]
    assert moments == ["cannot open /home/xxxxx/laser.yaml"]


def test_a_report_that_is_too_large_is_refused(
    bag: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz.features.reports.writing.MAX_BYTES", 1000)
    path = tmp_path / "bug.zip"
    with open_bag(bag) as source, pytest.raises(Error, match="larger than 0 MB"):
        make_report(parse(stories.CONFIG, "it"), source, Pictured(None), path)
    assert not list(tmp_path.iterdir())


def test_the_list_writes_nothing(
    bag: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert cli(["report", "--bag", str(bag), "--list"]) == 0
    lines = capfd.readouterr().out.splitlines()
    assert lines[0].startswith("slice.mcap: 6.0 s of ")
    assert lines[-1].startswith("Names of hosts, users and home folders are left out")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("ahead_s", [0.0, 1e6], ids=["of its time", "simulated"])
def test_a_slice_has_no_finding_that_the_bag_lacks(tmp_path: Path, ahead_s: float) -> None:
    """It begins with the transforms of the seconds before, of which some frames have the last."""
    bag = Bag()
    bag.add("/odom", "nav_msgs/msg/Odometry")
    for step in range(400):
        at_s = step / 20
        stamp_ns = START_NS + ns(at_s - ahead_s)
        for child in ("base", *(["arm"] if at_s < 7 else [])):
            bag.topics.setdefault("/tf", Topic(TF))
            bag.put(at_s + 0.001, "/tf", {"transforms": [stamped("odom", child, stamp_ns, at_s)]})
        twist = {"pose": {"covariance": COVARIANCE}, "twist": {"covariance": COVARIANCE}}
        odometry = {"header": header("odom", stamp_ns), "child_frame_id": "base", **twist}
        bag.put(at_s + 0.002, "/odom", odometry)
    path = bag.write_file(tmp_path / "run.mcap")
    text = "{fixed_frame: odom, displays: [{type: Odometry, topic: /odom}, {type: TF}]}"
    config, zipped = parse(text, "the config"), tmp_path / "bug.zip"
    with open_bag(path) as source:
        make_report(config, source, Pictured(None), zipped, span=(10.0, 18.0), name="run")
    results: list[set[str]] = []
    for each in (path, read_report(zipped, tmp_path).bag):
        with open_bag(each) as source:
            report = examine_bag(source, config, each.name, lambda what, share: None)
            results.append({finding.id for finding in report.findings})
    assert not results[1] - results[0]


def test_a_slice_that_ends_in_a_gap_does_not_say_that_a_topic_stops(tmp_path: Path) -> None:
    bag = Bag()
    bag.add("/odom", "nav_msgs/msg/Odometry")
    for step in range(400):
        at_s = step / 20
        bag.topics.setdefault("/tf", Topic(TF))
        bag.put(at_s, "/tf", {"transforms": [stamped("odom", "base", START_NS + ns(at_s), at_s)]})
        if not 15.2 < at_s < 18.3:  # too short for a finding in the bag
            values = {"header": header("odom", START_NS + ns(at_s)), "child_frame_id": "base"}
            bag.put(at_s, "/odom", values | {"pose": {"covariance": COVARIANCE}})
    path = bag.write_file(tmp_path / "run.mcap")
    text = "{fixed_frame: odom, displays: [{type: Odometry, topic: /odom}]}"
    config, zipped = parse(text, "the config"), tmp_path / "bug.zip"
    with open_bag(path) as source:
        make_report(config, source, Pictured(None), zipped, span=(10.0, 18.2), name="run")
    for each in (path, read_report(zipped, tmp_path).bag):
        with open_bag(each) as source:
            report = examine_bag(source, config, each.name, lambda what, share: None)
        assert "GRAPH009" not in {finding.id for finding in report.findings}


def test_the_browser_of_the_picture_is_not_listed(browser: playwright.Browser) -> None:
    with contextlib.closing(HeadlessRenderer(browser, 200, 150)) as renderer:
        assert not renderer.scene.browsers.reports()


@pytest.mark.parametrize(
    ("span", "at", "sentence"),
    [
        ((3.0, 3.0), None, "--from 3 s must be before --to 3 s."),
        ((2.0, 4.0), 1.9, "--at 1.9 s must be between --from 2 s and --to 4 s."),
        ((2.0, 4.0), 4.1, "--at 4.1 s must be between --from 2 s and --to 4 s."),
        ((2.0, 2.5), 2.0, ""),
        ((2.0, 2.5), 2.5, ""),
    ],
)
def test_the_shown_moment_is_in_the_span(
    bag: Path, span: tuple[float, float], at: float | None, sentence: str
) -> None:
    config, text = parse("{displays: []}", "it"), ""
    with open_bag(bag) as source:
        try:
            listed = make_report(config, source, Pictured(None), None, span=span, at=at)
            assert "slice.mcap: 0.5 s of " in listed
        except TimeError as error:
            text = str(error)
    assert text == sentence


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["-o", "bug.txt"], "bug.txt must end with .zip."),
        ([], "Give either -o FILE or --list."),
        (["--list", "--from", "3"], "--from needs --bag."),
    ],
)
def test_invalid_arguments(
    arguments: list[str], sentence: str, capfd: pytest.CaptureFixture[str]
) -> None:
    assert cli(["report", *arguments]) == 2
    assert capfd.readouterr().err == f"webviz: {sentence}\n"


def test_a_zip_file_that_is_not_a_report(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "other.zip"
    path.write_bytes(b"PK")
    assert cli([str(path), "--port", "0"]) == 1
    assert "is not a bug report that can be opened" in capfd.readouterr().err
