"""A second run beside a bag: moved in time, with topics and transforms of its own."""

from __future__ import annotations

import base64
import contextlib
import re
import zlib
from collections.abc import Iterator
from pathlib import Path

import pytest
from bags import START_NS, Bag, ns

from webviz.api.nodes import Points
from webviz.commands import Seek
from webviz.data.messages import TFMessage, decode, definition, encode
from webviz.data.messages.stamps import shifted
from webviz.engine.parts.comparison_config import OPACITY, with_comparison
from webviz.files.opening import parse
from webviz.files.report import read_report
from webviz.shell.cli import main as cli
from webviz.shell.testing import BagViewer, header
from webviz.sources.bag.comparison import DIFFERENCE, DISTANCE, Align, ComparisonRun
from webviz.sources.bag.history import BagHistory
from webviz.sources.player import Player
from webviz.sources.slices import slice_around

CONFIG = """\
version: 1
fixed_frame: map
displays:
- {type: Grid}
- {type: Group, name: Sensors, displays: [{type: LaserScan, name: Scan, size: 0.1}]}
"""
TF = "tf2_msgs/msg/TFMessage"
TWIST = "geometry_msgs/msg/Twist"
CAR = f"geometry_msgs/Twist motion\n{'=' * 80}\nMSG: geometry_msgs/Twist\n{definition(TWIST)}"
AHEAD_M = 1.0
"""Distance in metres to the second run, which drives as fast and begins later."""
LATER_S = 2.0


def write(path: Path, begin_s: float, ahead_m: float) -> Path:
    """A robot that drives along x, one metre a second, for six seconds."""
    bag = Bag()
    bag.add("/scan", "sensor_msgs/msg/LaserScan", best_effort=True)
    bag.add("/speed", "std_msgs/msg/Float64")
    bag.add("/car", "cars_of_comparison/msg/Car", definition=CAR)
    bag.put(begin_s, "/car", b"\0\1\0\0" + bytes(48))
    bag.transform(begin_s, "map", "odom", static=True)
    for step in range(61):
        at_s = begin_s + step / 10
        bag.transform(at_s, "odom", "base", x=step / 10 + ahead_m)
        bag.put(at_s, "/speed", {"data": 1.0 + ahead_m})
        ranges = {"angle_increment": 0.1, "range_max": 9.0, "ranges": [1.0]}
        bag.put(at_s, "/scan", ranges | {"header": header("base", START_NS + ns(at_s))})
    return bag.write(path)


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    folder = tmp_path_factory.mktemp("runs")
    return write(folder / "today", 0.0, 0.0), write(folder / "yesterday", LATER_S, AHEAD_M)


@contextlib.contextmanager
def viewer(runs: tuple[Path, Path], align: Align | float) -> Iterator[BagViewer]:
    today, yesterday = runs
    history = BagHistory(today, comparison=ComparisonRun(yesterday, align, "/speed.data"))
    config = with_comparison(parse(CONFIG, "the config"), history)
    with contextlib.closing(BagViewer(history, config)) as bag_viewer:
        yield bag_viewer


def x_of(bag_viewer: BagViewer, frame: str) -> float:
    return bag_viewer.loop.buffer.lookup("map", frame, 0).translation[0]


@pytest.mark.parametrize(
    ("align", "other_m"),
    [("start", 4.0), ("stamp", 2.0), ("path", 3.0), (0.5, 3.5)],
)
def test_both_runs_are_shown_at_a_time(
    runs: tuple[Path, Path], align: Align | float, other_m: float
) -> None:
    with viewer(runs, align) as bag_viewer:
        bag_viewer.do(Seek(3.0))
        assert x_of(bag_viewer, "base") == pytest.approx(3.0, abs=1e-6)
        assert x_of(bag_viewer, "ghost/base") == pytest.approx(other_m, abs=0.11)
        rows = {row.name: row.statuses for row in bag_viewer.rows}
        assert rows["Scan (ghost)"]["Transform"].text == "Transform OK"
        bag_viewer.do(Seek(1.0))  # back
        assert x_of(bag_viewer, "base") == pytest.approx(1.0, abs=1e-6)


def numbers(source: Player, topic: str) -> list[float]:
    history = source.history
    result = history.messages(history.channels_of(topic), history.start_ns)
    return [decode(each.type, each.cdr).data for each in result]


def test_the_distance_and_a_difference_over_time(runs: tuple[Path, Path]) -> None:
    with viewer(runs, "start") as bag_viewer:
        distances = numbers(bag_viewer.source, DISTANCE)
        assert len(distances) == 61
        assert distances == pytest.approx([AHEAD_M] * 61)
        assert numbers(bag_viewer.source, DIFFERENCE) == pytest.approx([-AHEAD_M] * 61)
        (plot,) = [tab.panel for tab in bag_viewer.loop.state().panels if tab.panel.name == "Ghost"]
        assert plot.curves == [f"{DISTANCE}.data", f"{DIFFERENCE}.data"]  # pyright: ignore
        assert plot.units == {f"{DISTANCE}.data": "m"}, "a number has none"  # pyright: ignore


def test_a_difference_has_the_unit_that_the_type_in_the_bag_states(runs: tuple[Path, Path]) -> None:
    history = BagHistory(
        runs[0], comparison=ComparisonRun(runs[1], "start", "/car.motion.linear.x")
    )
    (plot,) = with_comparison(parse(CONFIG, "the config"), history).panels
    assert plot.units[f"{DIFFERENCE}.data"] == "m/s"  # pyright: ignore
    history.close()


def test_a_slice_has_both_runs(runs: tuple[Path, Path]) -> None:
    with viewer(runs, "start") as bag_viewer:
        bag_viewer.do(Seek(3.0))
        part, _ = slice_around(bag_viewer.source)
        topics = [channel.topic for channel, _, _ in part.messages()]
    for topic in ("/scan", "/tf"):
        assert topics.count(f"/ghost{topic}") == topics.count(topic) == 61


def test_copies_are_tinted_and_read_topics_of_their_own(runs: tuple[Path, Path]) -> None:
    with viewer(runs, "start") as bag_viewer:
        rows = {row.name: row.display for row in bag_viewer.rows}
        assert [*rows] == ["Grid", "Sensors", "Scan", "Ghost", "Scan (ghost)"]
        first, second = rows["Scan"], rows["Scan (ghost)"]
        assert first is not None
        assert second is not None
        assert second.topic.name == "/ghost/scan"  # pyright: ignore
        assert second.size == first.size  # pyright: ignore
        ids = {row.name: row.id for row in bag_viewer.loop.state().rows}

        def points(name: str) -> Points:
            ((_, _, node),) = bag_viewer.scene.visible(f"{ids[name]}/")
            assert isinstance(node, Points)
            return node

        bag_viewer.do(Seek(2.0))
        own, other = points("Scan"), points("Scan (ghost)")
        assert own.opacity == 1.0
        assert other.opacity == pytest.approx(OPACITY)
        bag_viewer.do(Seek(3.0))
        assert points("Scan (ghost)").opacity == pytest.approx(OPACITY), "once"


def test_all_stamps_of_a_message_are_moved() -> None:
    stamps = [(5, 0), (0, 0), (7, 999_999_999)]
    transforms = [
        {"header": {"stamp": {"sec": sec, "nanosec": nanosec}, "frame_id": "map"}}
        for sec, nanosec in stamps
    ]
    cdr = encode(TF, {"transforms": transforms})
    message: TFMessage = decode(TF, shifted(TF, cdr, 1_500_000_001))
    assert [each.stamp_ns for each in message.transforms] == [6_500_000_001, 0, 9_500_000_000]
    assert shifted(TF, shifted(TF, cdr, 10**9), -(10**9)) == cdr


def test_malformed_messages_stay_as_they_are() -> None:
    cdr = encode(TF, {"transforms": [{"header": {"stamp": {"sec": 1}, "frame_id": "map"}}] * 3})
    for end in range(len(cdr)):
        assert len(shifted(TF, cdr[:end], 10**9)) == end
    for place in range(len(cdr)):
        changed = bytearray(cdr)
        changed[place] ^= 0xFF
        assert len(shifted(TF, bytes(changed), 10**9)) == len(cdr)


def test_a_report_of_two_runs_has_both_at_the_same_places(
    runs: tuple[Path, Path], tmp_path: Path
) -> None:
    (config := tmp_path / "lab.yaml").write_text(CONFIG)
    command = ["--bag", str(runs[0]), "-d", str(config), "--ghost", str(runs[1])]
    zipped = tmp_path / "bug.zip"
    arguments = ["report", *command, "--ghost-align", "path", "--at", "4", "--no-picture"]
    assert cli([*arguments, "-o", str(zipped)]) == 0
    (folder := tmp_path / "out").mkdir()
    unpacked = read_report(zipped, folder)
    assert unpacked.report.at_s == pytest.approx(4.0)
    with viewer(runs, "path") as bag_viewer:
        bag_viewer.do(Seek(4.0))
        expected = x_of(bag_viewer, "ghost/base")
    with contextlib.closing(BagViewer(unpacked.bag, unpacked.config.read_text())) as bag_viewer:
        bag_viewer.do(Seek(unpacked.report.at_s))
        assert x_of(bag_viewer, "ghost/base") == pytest.approx(expected)
        assert [row.name for row in bag_viewer.rows][-1] == "Scan (ghost)"
        assert DISTANCE in bag_viewer.source.offers()


def test_two_runs_are_exported_with_their_distance(runs: tuple[Path, Path], tmp_path: Path) -> None:
    path = tmp_path / "run.html"
    command = ["export", str(runs[0]), "--ghost", str(runs[1]), "--ghost-align", "path"]
    assert cli([*command, "--rate", "1", "-o", str(path)]) == 0
    page = path.read_text()
    chunks = re.findall(r'<script type="webviz/chunk">(.*?)</script>', page, re.DOTALL)
    first = zlib.decompress(base64.b64decode(chunks[0]), wbits=31)
    assert b"LaserScan (ghost)" in first
    assert f"{DISTANCE}.data".encode() in first


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["--ghost", "a.mcap"], "--ghost needs --bag."),
        (["report", "--ghost", "a", "-o", "a.zip"], "--ghost needs --bag."),
        (["export", "a", "--ghost-align", "path", "-o", "a.html"], "--ghost-align and"),
        (["--bag", "a", "--ghost-align", "path"], "--ghost-align and --ghost-difference need"),
        (["--bag", "a", "--ghost", "b", "--ghost-align", "x"], "x is not start, stamp, path or"),
    ],
)
def test_invalid_arguments(
    arguments: list[str], sentence: str, capfd: pytest.CaptureFixture[str]
) -> None:
    assert cli(arguments) == 2
    assert sentence in capfd.readouterr().err


def test_unknown_paths_and_numbers_are_one_sentence(
    runs: tuple[Path, Path], tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    bag = Bag()
    bag.add("/speed", "std_msgs/msg/Float64")
    bag.put(0.0, "/speed", {"data": 1.0})
    other = str(bag.write(tmp_path / "other"))
    command = ["--bag", str(runs[0]), "--ghost", other, "--port", "0"]
    assert cli([*command, "--ghost-align", "path"]) == 1
    assert "The paths of the robots are unknown" in capfd.readouterr().err
    assert cli([*command, "--ghost-difference", "/speed.no"]) == 1
    assert "Cannot read /speed.no: " in capfd.readouterr().err
    assert cli([*command, "--ghost-difference", "/none.data"]) == 1
    assert "has no messages on /none" in capfd.readouterr().err
