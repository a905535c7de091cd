"""The commands and programs of the documentation, run as they stand there.

A block whose title says what it needs, such as an apt ROS 2, is not run. A process that imported
webviz is forked for each, which takes a third of the time of starting anew, and runs a command as
its script would.
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

import forked
import pytest
import stories
from bags import START_NS, Bag, ns
from certificates import certificate
from doc_blocks import CONFIG, ROOT, Block, blocks
from program import Program

from tests.site.example import drive
from webviz.files.opening import parse
from webviz.shell.report.making import make_report
from webviz.shell.report.scenes import Pictured
from webviz.shell.testing import header
from webviz.sources.bag.history import BagHistory
from webviz.sources.player import Player

pytest.importorskip("rclpy", reason="needs rclpy")

COMMANDS = {
    words: f"{block}: {' '.join(words)}"
    for block in reversed(blocks("sh"))
    for words in block.commands()
    if not block.title and words[0] not in ("make", "export")
}
"""The first place of each command, by its words."""
PROGRAMS = [
    each
    for each in blocks("python")
    if "webviz.Viewer(" in each.text and "import webviz" in each.text  # not cells of notebooks
]
TESTS = [each for each in blocks("python") if "\ndef test_" in each.text]
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
TELLING = """
import sys, threading, time

def tell(viewer):
    def waits(frame):
        return frame and (frame.f_code.co_name == "result" or waits(frame.f_back))

    def run():
        while not waits(sys._current_frames()[threading.main_thread().ident]):
            time.sleep(0.01)
        print("open", viewer.url, flush=True)

    threading.Thread(target=run, daemon=True).start()
"""
"""Begins a program that prints the address once Ctrl-C reaches it in `wait`."""
TESTING = """
from pathlib import Path
import pytest

Path("test_robot.py").write_text(TEXT)
assert pytest.main(["-p", "no:cacheprovider", "--update-pictures", "test_robot.py"]) == 0
assert {path.name for path in Path("pictures").iterdir()} == {"scan.png", "costs.png"}
"""
"""Runs the tests of a package that are in `TEXT`."""


def outcome(
    work: tuple[str, ...] | str, example_folder: Path, folder: Path
) -> tuple[int | None, str]:
    """Run a command or a program beside the files that pages name; Ctrl-C ends what would run on.

    Returns:
        Its exit status, and what it printed.
    """
    here = folder / "here"
    here.mkdir()
    words = () if isinstance(work, str) else work
    outputs = {after for before, after in itertools.pairwise(words) if before == "-o"}
    for path in example_folder.iterdir():
        if path.name not in outputs:
            (here / path.name).symlink_to(path)
    log = folder / "output.txt"
    log.touch()
    context = multiprocessing.get_context("forkserver")
    does = work if isinstance(work, str) else on_this_machine(work)
    process = context.Process(target=forked.run, args=(does, here, log))
    process.start()
    assert process.pid is not None
    deadline = time.monotonic() + forked.PATIENCE_S
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
    results = [ELSEWHERE.get(word, word) for word in words[1:]]
    if results[:1] and results[0] in END:
        return results
    for option in {"--port", "--http"} & {*results}:
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            results[results.index(option) + 1] = str(probe.getsockname()[1])
    if "--port" not in results and "--help" not in results:
        at = results.index("--ros-args") if "--ros-args" in results else len(results)
        results[at:at] = ["--port", "0"]
    return results


@pytest.fixture(scope="module")
def example_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
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
    long = Bag()
    for at_s in range(21):
        long.transform(at_s, "map", "odom")
    long.write(folder / "long")
    (folder / "lab.yaml").write_text(CONFIG.text)
    (folder / "nav2.yaml").write_text(f"{CONFIG.text}watch: [{{rule: Scan.walls > 0.8}}]\n")
    for name in ("nav2.rviz", "nav2_default_view.rviz"):
        (folder / name).write_text("Visualization Manager:\n  Displays: []\n")
    certificate(folder)
    (folder / "displays").symlink_to(ROOT / "displays")
    (folder / "tests").mkdir()
    reported = stories.write(folder / "turned", "turned")
    with contextlib.closing(Player(BagHistory(reported))) as source:
        config = parse(stories.CONFIG, "the config")
        make_report(config, source, Pictured(None), folder / "bug.zip", span=(2.0, "end"), at=5.0)
    return folder


def program_of(block: Block) -> str:
    """A program that says when Ctrl-C may come; the default port may be taken, the run is long."""
    program = block.text.replace('Viewer("lab.yaml"', 'Viewer("lab.yaml", port=0')
    program = program.replace('bag="run.mcap"', 'bag="long"')
    return TELLING + program.replace("viewer.wait()", "tell(viewer)\n    viewer.wait()")


def package_of(block: Block) -> str:
    """A program that runs the tests for a package."""
    return f"TEXT = {block.text!r}\n{TESTING}"


WORK = {
    **COMMANDS,
    **{program_of(block): str(block) for block in PROGRAMS},
    **{package_of(block): str(block) for block in TESTS},
}


@pytest.fixture(scope="module")
def outcomes(
    example_folder: Path, ros_env: dict[str, str], tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Mapping[tuple[str, ...] | str, Future[tuple[int | None, str]]]]:
    """Run all commands and programs beside a simulated robot, several at once."""
    multiprocessing.set_forkserver_preload(["warm"])
    robot = Program([sys.executable, "-m", "webviz_sim"], ros_env, example_folder / "robot.txt")
    try:
        with pytest.MonkeyPatch.context() as patch, ThreadPoolExecutor(AT_ONCE) as pool:
            patch.setenv("PYTHONPATH", str(ROOT / "tests/support"))
            yield {
                work: pool.submit(outcome, work, example_folder, tmp_path_factory.mktemp("work"))
                for work in WORK
            }
    finally:
        robot.end()


@pytest.mark.parametrize("work", WORK, ids=WORK.values())
def test_a_command_or_program_does_its_work(
    work: tuple[str, ...] | str,
    outcomes: Mapping[tuple[str, ...] | str, Future[tuple[int | None, str]]],
) -> None:
    status, output = outcomes[work].result()
    expected = {0}
    if not isinstance(work, str) and {*work[1:2]} & EXAMINE:
        expected |= {1, 3} if "This machine is busy" in output else {3}
    if "since ffmpeg is not installed" in output:
        expected = {4}
    assert status in expected, output
    assert "Traceback" not in output
