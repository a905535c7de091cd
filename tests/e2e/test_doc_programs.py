"""The programs of the documentation, run as they stand there."""

from __future__ import annotations

import signal
import sys
from pathlib import Path

import pytest
from bags import Bag
from doc_blocks import CONFIG, Block, blocks
from program import Program

pytest.importorskip("rclpy", reason="needs rclpy")

PROGRAMS = [
    each
    for each in blocks("python")
    if "webviz.Viewer(" in each.text and "import webviz" in each.text  # not cells of notebooks
]
TESTS = [each for each in blocks("python") if "\ndef test_" in each.text]


def recorded() -> Bag:
    """A run of 20 s."""
    bag = Bag()
    for at_s in range(21):
        bag.transform(at_s, "map", "odom")
    return bag


TELLING = """
import sys, threading, time

def tell(viewer):
    def waits(frame):
        return frame and (frame.f_code.co_name == "result" or waits(frame.f_back))

    def run():
        while not waits(sys._current_frames()[threading.main_thread().ident]):
            time.sleep(0.01)
        print(viewer.url, flush=True)

    threading.Thread(target=run, daemon=True).start()
"""
"""Begins a program that prints the address once Ctrl-C reaches it in `wait`."""


@pytest.mark.parametrize("block", PROGRAMS, ids=str)
def test_a_program_shows_its_page_until_ctrl_c(
    block: Block, tmp_path: Path, ros_env: dict[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("lab.yaml").write_text(CONFIG.text)
    if "run.mcap" in block.text:
        recorded().write(tmp_path / "run")
        next(Path("run").glob("*.mcap")).rename("run.mcap")
    # The default port may be taken.
    shown = block.text.replace('Viewer("lab.yaml"', 'Viewer("lab.yaml", port=0')
    lines = TELLING + shown.replace("viewer.wait()", "tell(viewer)\n    viewer.wait()")
    program = Program([sys.executable, "-c", lines], ros_env, tmp_path / "output.txt")
    program.url()
    assert program.end(signal.SIGINT) == 0, program.output()
    assert "Traceback" not in program.output()


@pytest.mark.parametrize("block", TESTS, ids=str)
def test_the_tests_for_a_package_pass_with_their_pictures(
    block: Block, tmp_path: Path, ros_env: dict[str, str]
) -> None:
    (tmp_path / "lab.yaml").write_text(CONFIG.text)
    (tmp_path / "test_robot.py").write_text(block.text)
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "--update-pictures"]
    program = Program([*command, str(tmp_path)], ros_env, tmp_path / "output.txt")
    program.process.wait(180)
    assert program.process.returncode == 0, program.output()
    assert {path.name for path in (tmp_path / "pictures").iterdir()} == {"scan.png", "costs.png"}
