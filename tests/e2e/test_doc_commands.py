"""The commands of the documentation, run as they stand there.

A block whose title says what it needs, such as an apt ROS 2, is not run. A process that imported
webviz is forked for each command, which takes a third of the time of starting anew, and runs the
program as its script would.
"""

from __future__ import annotations

import contextlib
import itertools
import multiprocessing
import os
import re
import signal
import socket
import sys
import time
from collections.abc import Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path

import pytest
import stories
from bags import START_NS, ns
from certificates import certificate
from doc_blocks import CONFIG, ROOT, blocks
from program import PATIENCE_S, Program

from tests.site.example import drive
from webviz.files.opening import parse
from webviz.shell.cli import ending, program
from webviz.shell.report.making import make_report
from webviz.shell.report.scenes import Pictured
from webviz.shell.testing import header
from webviz.sources.bag.source import BagSource

pytest.importorskip("rclpy", reason="needs rclpy")

COMMANDS = {
    words: f"{block}: {' '.join(words)}"
    for block in reversed(blocks("sh"))
    for words in block.commands()
    if not block.title and words[0] not in ("make", "export")
}
"""The first place of each command, by its words."""
EXAMINE = {"doctor", "frames", "test"}
"""Their exit status is 3 if there is a fault, such as that of a graph with a second viewer."""
END = {*EXAMINE, "export", "screenshot", "record"}
"""They serve no page."""
BUSY = re.compile(r"open https?://|recording to |agents at http")
"""Printed by what runs until Ctrl-C."""
CLOSED = "ws://127.0.0.1:1"
ELSEWHERE = {"0.0.0.0": "127.0.0.1", "ws://robot:8765": CLOSED, "ws://robot:9090": CLOSED}
"""Addresses of other machines, and what a test puts in their place."""
AT_ONCE = 4
DRIVE_S, SHORT_S = 6.0, 0.4


def run(arguments: list[str], folder: Path, log: Path) -> None:
    """Do what the script `webviz` does, in a folder, with its output in a file."""
    os.chdir(folder)
    os.environ["XDG_STATE_HOME"] = str(log.parent)  # nothing is restored
    file = os.open(log, os.O_WRONLY | os.O_CREAT)
    os.dup2(file, 1)
    os.dup2(file, 2)
    ending.PATIENCE_S = PATIENCE_S  # a busy machine delays what is closed
    sys.argv = ["webviz", *arguments]
    program()


def outcome(words: tuple[str, ...], made: Path, folder: Path) -> tuple[int | None, str]:
    """Run a command beside the files that pages name, with Ctrl-C where it runs until then.

    Returns:
        Its exit status, and what it printed.
    """
    here = folder / "here"
    here.mkdir()
    written = {after for before, after in itertools.pairwise(words) if before == "-o"}
    for path in made.iterdir():
        if path.name not in written:
            (here / path.name).symlink_to(path)
    log = folder / "output.txt"
    log.touch()
    context = multiprocessing.get_context("forkserver")
    process = context.Process(target=run, args=(on_this_machine(words), here, log))
    process.start()
    assert process.pid is not None
    deadline = time.monotonic() + PATIENCE_S
    try:
        while process.is_alive() and time.monotonic() < deadline:
            if BUSY.search(log.read_text()):
                os.kill(process.pid, signal.SIGINT)
                break
            time.sleep(0.05)
        process.join(max(0.0, deadline - time.monotonic()))
    finally:
        process.kill()
    return process.exitcode, log.read_text()


def on_this_machine(words: tuple[str, ...]) -> list[str]:
    """The arguments, with addresses and ports that are free on this machine."""
    found = [ELSEWHERE.get(word, word) for word in words[1:]]
    if found[:1] and found[0] in END:
        return found
    for option in {"--port", "--http"} & {*found}:
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            found[found.index(option) + 1] = str(probe.getsockname()[1])
    if "--port" not in found and "--help" not in found:
        at = found.index("--ros-args") if "--ros-args" in found else len(found)
        found[at:at] = ["--port", "0"]
    return found


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the files that the pages name."""
    folder = tmp_path_factory.mktemp("made")
    bag = drive(DRIVE_S)
    bag.add("/front/scan", "sensor_msgs/msg/LaserScan")
    bag.add("/odom", "nav_msgs/msg/Odometry")
    for at_s, topic, values in tuple(bag.messages):
        if topic == "/scan":
            bag.put(at_s, "/front/scan", values)
            bag.put(at_s, "/odom", {"header": header("map", START_NS + ns(at_s))})
    bag.write(folder / "drive")
    (recorded,) = (folder / "drive").glob("*.mcap")
    for name in ("run", "morning", "noon", "today", "yesterday"):
        (folder / f"{name}.mcap").symlink_to(recorded)
    bag.messages = [each for each in bag.messages if each[0] < SHORT_S]
    bag.write(folder / "run")
    (folder / "lab.yaml").write_text(CONFIG.text)
    (folder / "nav2.yaml").write_text(f"{CONFIG.text}watch: [{{rule: Scan.walls > 0.8}}]\n")
    for name in ("nav2.rviz", "nav2_default_view.rviz"):
        (folder / name).write_text("Visualization Manager:\n  Displays: []\n")
    certificate(folder)
    (folder / "displays").symlink_to(ROOT / "displays")
    (folder / "tests").mkdir()
    reported = stories.write(folder / "turned", "turned")
    with contextlib.closing(BagSource(reported)) as source:
        config = parse(stories.CONFIG, "the config")
        make_report(config, source, Pictured(None), folder / "bug.zip", span=(2.0, "end"), at=5.0)
    return folder


@pytest.fixture(scope="module")
def outcomes(
    made: Path, ros_env: dict[str, str], tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Mapping[tuple[str, ...], Future[tuple[int | None, str]]]]:
    """Of all commands, several of which run at once, beside a simulated robot."""
    multiprocessing.set_forkserver_preload(["warm"])
    robot = Program([sys.executable, "-m", "webviz_sim"], ros_env, made / "robot.txt")
    try:
        with pytest.MonkeyPatch.context() as patch, ThreadPoolExecutor(AT_ONCE) as pool:
            patch.setenv("PYTHONPATH", str(ROOT / "tests/support"))
            yield {
                words: pool.submit(outcome, words, made, tmp_path_factory.mktemp("command"))
                for words in COMMANDS
            }
    finally:
        robot.end()


@pytest.mark.parametrize("words", COMMANDS, ids=COMMANDS.values())
def test_a_command_does_its_work(
    words: tuple[str, ...],
    outcomes: Mapping[tuple[str, ...], Future[tuple[int | None, str]]],
) -> None:
    status, output = outcomes[words].result()
    expected = {0}
    if {*words[1:2]} & EXAMINE:
        expected |= {1, 3} if "This machine is busy" in output else {3}
    assert status in expected, output
    assert "Traceback" not in output
