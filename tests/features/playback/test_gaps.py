"""Bags of decades: a clock that was set while they were recorded, or a robot that slept."""

from __future__ import annotations

import itertools
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from bags import START_NS, Bag, ns

from webviz.api.declared import Topic
from webviz.commands import Seek
from webviz.files.config import WatchRule
from webviz.shell.app.reading import read_config
from webviz.shell.doctor.examination import examine_bag
from webviz.shell.doctor.rule_results import RuleResults
from webviz.shell.pictures.times import every
from webviz.shell.testing import header
from webviz.shell.testing.seeking import BagViewer
from webviz.sources import Subscription
from webviz.sources.bag.history import BagHistory
from webviz.sources.player import Player
from webviz.sources.steps import EVEN_STEPS, steps_of

REPORTS = Path(__file__).parents[4] / "shared/data/reports/T6"
STEP_NS = 100_000_000
YEARS_S = START_NS / 1e9
"""Time in seconds from 1970 to when the clock was set."""
COMMAND_S = 60.0
CONFIG = "fixed_frame: map\ndisplays: [{type: Marker, topic: /marker, name: M}]"


def jumping(
    before: int = 20, after: int = 100, jump_s: float = YEARS_S, late_s: float = 0.0
) -> Bag:
    """A clock that is set while it records; markers at x = 0, 1, 2, ... ten times a second.

    `late_s` delays those after the jump.
    """
    bag = Bag()
    bag.add("/marker", "visualization_msgs/msg/Marker")
    for number in range(before + after):
        at_s = number / 10 - (jump_s if number < before else -late_s)
        bag.transform(at_s, "map", "base", float(number))
        head = header("map", START_NS + ns(at_s))
        pose = {"position": {"x": float(number)}, "orientation": {"w": 1.0}}
        shape = {"type": 1, "scale": {"x": 1.0, "y": 1.0, "z": 1.0}, "color": {"a": 1.0}}
        bag.put(at_s, "/marker", {"header": head, "pose": pose, **shape})
    return bag


@pytest.fixture(scope="module")
def jump(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return jumping().write(tmp_path_factory.mktemp("bags") / "jump")


def walked(bag: Player, step_ns: float = STEP_NS) -> list[int]:
    bag.want({"/marker": Subscription("visualization_msgs/msg/Marker", Topic("/marker"))})
    times: list[int] = []
    for at_ns in steps_of(bag, bag.history.start_ns, bag.history.end_ns, step_ns):
        while bag.reached_ns < at_ns:
            bag.play_until(at_ns)
            bag.inbox.drain()
        times.append(at_ns)
    return times


def test_steps_are_even_while_there_are_messages(tmp_path: Path) -> None:
    bag = Player(BagHistory(jumping(20, 100, EVEN_STEPS / 10).write(tmp_path / "bag")))
    length_ns = bag.history.end_ns - bag.history.start_ns
    assert walked(bag) == [
        bag.history.start_ns + i * STEP_NS for i in range(length_ns // STEP_NS + 1)
    ]
    bag.close()


@pytest.mark.parametrize("jump_s", [60.0, 3600.0, 86400.0, YEARS_S])
def test_steps_over_silence_are_few_and_end_just_before_the_next_message(
    tmp_path: Path, jump_s: float
) -> None:
    bag = Player(BagHistory(jumping(jump_s=jump_s).write(tmp_path / "bag")))
    times = walked(bag)
    bag.close()
    assert len(times) < 450
    assert times == sorted(set(times))
    assert (times[0], times[-1]) == (bag.history.start_ns, bag.history.end_ns)
    (before,) = (t for t, after in itertools.pairwise(times) if t < START_NS + 2 * 10**9 <= after)
    assert START_NS + 2 * 10**9 - before <= 1.1 * STEP_NS


def test_a_rule_sees_both_sides_of_a_jump_and_how_long_it_lasted(jump: Path) -> None:
    with_age = ("/marker.rate > 0.001", "/marker.pose.position.x < 119", "doctor.errors < 100")
    results = RuleResults("bag", [WatchRule(rule=text) for text in with_age])
    bag = Player(BagHistory(jump))
    start_s = time.process_time()
    examine_bag(bag, read_config(None, bag), "bag", lambda what, share: None, results)
    bag.close()
    assert time.process_time() - start_s < COMMAND_S
    rate, position, _ = results.all.values()
    # Just before the clock was set, nothing had come for years.
    assert rate.problem.startswith("/marker.rate is ")
    assert position.problem.startswith("/marker.pose.position.x is 119")


@pytest.mark.parametrize(
    "command",
    [
        ["test", "--bag", "BAG", "--rule", "/marker.pose.position.x > -5"],
        ["doctor", "--bag", "BAG"],
        ["frames", "--bag", "BAG"],
        ["export", "BAG", "-o", "OUT"],
        ["frames", "--bag", "BAG", "--at", "end", "-o", "a.svg"],
    ],
    ids=["test", "doctor", "frames", "export", "picture"],
)
def test_a_command_ends_and_shows_the_end(jump: Path, tmp_path: Path, command: list[str]) -> None:
    words = {"BAG": str(jump), "OUT": "out.html"}
    result = run(tmp_path, *(words.get(word, word) for word in command))
    assert result.returncode == 0, result.stdout + result.stderr
    if command[0] == "frames" and "-o" not in command:
        assert "base" in result.stdout
    assert not list(tmp_path.glob(".*"))


@pytest.mark.parametrize("name", ["hour_between", "day_between", "year_between", "zero_first"])
def test_a_rule_over_a_bag_of_a_report_is_judged_in_seconds(name: str, tmp_path: Path) -> None:
    if not REPORTS.is_dir():
        pytest.skip("the bags of reports are not there")
    rule = ("--rule", "/marker.pose.position.x > -5")
    result = run(tmp_path, "test", "--bag", str(REPORTS / name), *rule)
    assert result.returncode == 0, result.stdout + result.stderr
    assert "1 of 1 rule holds." in result.stdout


def test_the_end_of_a_report_with_a_message_of_1970_is_shown() -> None:
    if not REPORTS.is_dir():
        pytest.skip("the bags of reports are not there")
    viewer = BagViewer(REPORTS / "zero_first")
    viewer.do(Seek((viewer.source.history.end_ns - viewer.source.history.start_ns) / 1e9))
    assert viewer.source.reached_ns == viewer.source.history.end_ns
    assert "10." in str(viewer.visible_nodes())
    viewer.close()


@pytest.mark.parametrize("late_ns", [0, 77, 101, 133])
def test_a_seek_beyond_thirty_years_reaches_the_last_message(tmp_path: Path, late_ns: int) -> None:
    bag = jumping(late_s=late_ns / 1e9)  # seconds as floats have steps of 240 ns here
    viewer = BagViewer(bag.write(tmp_path / "bag"), CONFIG)
    for _ in range(2):
        viewer.do(Seek((viewer.source.history.end_ns - viewer.source.history.start_ns) / 1e9))
        assert viewer.source.reached_ns == viewer.source.history.end_ns
        assert "119." in str(viewer.visible_nodes())
        viewer.do(Seek(0.0))
        assert viewer.source.reached_ns == viewer.source.history.start_ns
    viewer.do(Seek(1e300))
    assert viewer.source.reached_ns == viewer.source.history.end_ns
    viewer.close()


def test_pictures_at_intervals_of_decades_have_their_times(jump: Path) -> None:
    class Decades:
        start_ns = 100 * 10**9
        end_ns = 1_700_000_000 * 10**9

    first, second, third = every("start", "end", 8e8, Decades(), "bag")
    assert (first, second) == (0.0, 8e8)
    assert third == pytest.approx(1.6e9 + 100, abs=1.0)
    with pytest.raises(Exception, match="the limit is 2000"):
        every("start", "end", 1e-300, Decades(), "bag")


def test_an_export_that_is_ended_leaves_no_part(jump: Path, tmp_path: Path) -> None:
    command = [sys.executable, "-m", "webviz", "export", str(jump), "-o", "out.html"]
    with subprocess.Popen([*command, "--rate", "1000"], cwd=tmp_path) as process:
        until_s = time.monotonic() + COMMAND_S
        while not list(tmp_path.glob(".*.part")) and time.monotonic() < until_s:
            time.sleep(0.01)
        process.send_signal(signal.SIGTERM)
        assert process.wait(COMMAND_S) == 130
    assert not list(tmp_path.iterdir())


def test_a_program_that_has_to_be_ended_by_force_leaves_no_part(tmp_path: Path) -> None:
    program = (
        "import time, pathlib\n"
        "from webviz.shell.cli.ending import end_in_time\n"
        "from webviz.shell.pictures.files import writing\n"
        "with writing(pathlib.Path('out.html')):\n"
        "    end_in_time()\n"
        "    while True: time.sleep(1)\n"
    )
    completed = subprocess.run(
        [sys.executable, "-c", program], cwd=tmp_path, timeout=COMMAND_S, capture_output=True
    )
    assert completed.returncode == 1
    assert b"exiting by force" in completed.stderr
    assert not list(tmp_path.iterdir())


def test_a_program_whose_threads_cannot_run_ends_all_the_same() -> None:
    program = (
        "import ctypes\n"
        "from webviz.shell.cli import ending\n"
        "ending.HUNG_S = 0.5\n"
        "ending.end_in_time()\n"
        "ctypes.PyDLL(None).pause()\n"  # keeps all other threads of Python waiting
    )
    completed = subprocess.run(
        [sys.executable, "-c", program], timeout=COMMAND_S, capture_output=True, check=False
    )
    assert (completed.returncode, completed.stdout, completed.stderr) == (1, b"", b"")


def run(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "webviz", *arguments],
        cwd=folder,
        timeout=COMMAND_S,
        capture_output=True,
        text=True,
        env={**os.environ, "NO_COLOR": "1"},
        check=False,
    )
