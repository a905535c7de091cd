"""Ends of programs: signals at any moment, a killed parent, parts that hang."""

from __future__ import annotations

import os
import pty
import random
import re
import signal
import subprocess
import sys
import time
import urllib.request
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path

import psutil
import pytest
from processes import command_lines
from program import Program

pytest.importorskip("rclpy", reason="needs rclpy")

LINES = {"", "webviz: interrupted.\n", "\nwebviz: stopped.\n"}
PATIENCE_S = 60.0
"""Time in seconds for what takes three seconds on a machine that does nothing else."""


def has_handlers(program: Program) -> bool:
    """Return whether the program, and not the Python that starts it, is who hears a signal."""
    return bool(signals(program, "SigCgt") & 1 << signal.SIGTERM - 1)


def signals(program: Program, name: str) -> int:
    """A set of signals of a program, see proc(5)."""
    status = Path(f"/proc/{program.process.pid}/status").read_text()
    (mask,) = re.findall(rf"{name}:\s*(\w+)", status)
    return int(mask, 16)


def has_simulator(program: Program) -> bool:
    """Return whether the program has started the simulator."""
    return any("webviz_sim" in line for line in command_lines(program.process.pid).values())


def family_of(program: Program) -> list[psutil.Process]:
    """The program and all that it started."""
    process = psutil.Process(program.process.pid)
    return [process, *process.children(recursive=True)]


def shared_memory(family: list[psutil.Process]) -> set[Path]:
    """The files of Fast DDS that processes share memory by."""
    results = set()
    for process in family:
        with suppress(FileNotFoundError, ProcessLookupError):  # it has ended
            maps = Path(f"/proc/{process.pid}/maps").read_text()
            names = re.findall(r"/dev/shm/fast(?:rtps|dds)_[0-9a-f]{16}", maps)
            results |= {Path(name) for name in names}
    return results


def check_nothing_is_left(family: list[psutil.Process], files: Iterable[Path] = ()) -> None:
    _, alive = psutil.wait_procs(family, PATIENCE_S)
    assert alive == []
    assert [file for file in files if file.exists()] == []


def check_end(
    program: Program, number: signal.Signals, when: str, *, in_terminal: bool = False
) -> str:
    """End the demo by a signal: one line, and nothing is left; returns the line.

    Args:
        program: the demo.
        number: of the signal.
        when: it is sent.
        in_terminal: whether it reaches all processes, as Ctrl-C in a terminal does.
    """
    family = family_of(program)
    files = shared_memory(family)
    for each in family if in_terminal else family[:1]:
        each.send_signal(number)
    status = program.process.wait(PATIENCE_S)
    output = re.sub("webviz: (open|only ROS nodes) .*\n", "", program.output())
    assert output in LINES, when
    assert status == (0 if "stopped" in output else 130), when
    check_nothing_is_left(family, files)
    return output


def begin(start: Callable[..., Program]) -> Program:
    """Start the demo, to the point from which it hears signals."""
    program = start("webviz", "demo", "--port", "0")
    while not has_handlers(program):
        time.sleep(0.001)
    return program


@pytest.fixture(scope="module")
def start_s(start: Callable[..., Program]) -> float:
    """Seconds that the demo takes to start here; Ctrl-C in a terminal then ends it."""
    program, began = begin(start), time.monotonic()
    assert b"<html" in urllib.request.urlopen(program.url(), timeout=60).read()
    program.wait_for("ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET shows it to all others")
    assert has_simulator(program)
    duration = time.monotonic() - began
    ended = check_end(program, signal.SIGINT, "once it has started", in_terminal=True)
    assert "stopped" in ended
    return duration


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_at_any_moment_of_its_start_ends_the_demo_with_one_line_and_leaves_nothing(
    start: Callable[..., Program], start_s: float, number: signal.Signals
) -> None:
    for delay in (0.0, random.random() * start_s):
        program = begin(start)
        time.sleep(delay)
        check_end(program, number, f"after {delay:.3f} s")


def test_the_simulator_ends_when_the_viewer_is_killed(start: Callable[..., Program]) -> None:
    for is_ready in (lambda program: program.url(), has_simulator):
        program = start("webviz", "demo", "--port", "0")
        while not is_ready(program):
            time.sleep(0.05)
        family = family_of(program)
        program.end(signal.SIGKILL)
        check_nothing_is_left(family)


def test_a_simulator_that_has_to_be_killed_leaves_nothing(start: Callable[..., Program]) -> None:
    program = start("webviz", "demo", "--port", "0")
    program.url()
    (simulator,) = (each for each in family_of(program) if "webviz_sim" in each.cmdline())
    while not shared_memory([simulator]):  # the address may come before it has joined ROS
        time.sleep(0.05)
    simulator.suspend()  # as one that is busy
    assert "stopped" in check_end(program, signal.SIGTERM, "beside a simulator that is busy")


def test_a_program_that_is_still_starting_leaves_nothing_of_a_busy_simulator(
    ros_env: dict[str, str], tmp_path: Path
) -> None:
    code = """
import subprocess, sys, time
from webviz.shell.cli.ending import until_signal
def work(stop):
    subprocess.Popen([sys.executable, "-m", "webviz_sim"])
    time.sleep(1000)
until_signal(work)
"""
    program = Program([sys.executable, "-c", code], ros_env, tmp_path / "log.txt")
    while not (files := shared_memory(family_of(program))):
        time.sleep(0.05)
    family = family_of(program)
    family[1].suspend()
    assert program.end(signal.SIGTERM) == 130
    check_nothing_is_left(family, files)


def test_a_closed_terminal_ends_the_demo_cleanly(ros_env: dict[str, str]) -> None:
    command = [sys.executable, "-m", "webviz", "demo", "--port", "0"]
    pid, terminal = pty.fork()
    if pid == 0:
        signal.signal(signal.SIGHUP, signal.SIG_DFL)  # which nohup ignores for the tests, too
        os.execve(sys.executable, command, ros_env)
    output = b""
    while b"http" not in output:
        output += os.read(terminal, 1000)
    family = psutil.Process(pid).children(recursive=True)
    os.close(terminal)
    _, status = os.waitpid(pid, 0)
    assert os.waitstatus_to_exitcode(status) == 0
    check_nothing_is_left(family)


def test_a_terminal_that_closes_while_something_is_written_is_not_an_error() -> None:
    code = """
import signal, time
from webviz.shell.cli.ending import finish, piped
signal.signal(signal.SIGHUP, signal.SIG_IGN)
def work():
    while True:
        print("at work")
        time.sleep(0.01)
finish(piped(work))
"""
    pid, terminal = pty.fork()
    if pid == 0:
        os.execv(sys.executable, [sys.executable, "-c", code])
    assert b"at work" in os.read(terminal, 1000)
    os.close(terminal)
    _, status = os.waitpid(pid, 0)
    assert os.waitstatus_to_exitcode(status) == 0


def test_nohup_survives_the_end_of_its_terminal(ros_env: dict[str, str], tmp_path: Path) -> None:
    command = ["nohup", sys.executable, "-m", "webviz", "--port", "0"]
    program = Program(command, ros_env, tmp_path / "log.txt")
    program.url()
    assert signals(program, "SigIgn") & 1 << signal.SIGHUP - 1
    program.process.send_signal(signal.SIGHUP)
    assert b"<html" in urllib.request.urlopen(program.url(), timeout=60).read()
    assert program.process.poll() is None
    assert program.end(signal.SIGTERM) == 0


def test_work_that_hangs_is_ended_by_force_with_its_child_processes(tmp_path: Path) -> None:
    code = """
import subprocess, time
from webviz.shell.cli.ending import until_signal
def work(stop):
    stop.hold()
    subprocess.Popen(["sleep", "1000"])
    print("at work", flush=True)
    time.sleep(1000)
until_signal(work)
"""
    program = Program([sys.executable, "-c", code], {}, tmp_path / "log.txt")
    program.wait_for("at work")
    family = family_of(program)
    assert len(family) == 2
    assert program.end(signal.SIGTERM) == 1
    assert program.output() == "at work\nwebviz: still busy after 3 s; exiting by force.\n"
    check_nothing_is_left(family)


BUSY = """
from pathlib import Path
from typing import Annotated
from webviz import Display, Input, Topic

class Busy(Display):
    # Keeps the frame loop busy as soon as there is a file beside this one.
    topic: Annotated[Topic, Input("std_msgs/msg/String")] = Topic("/busy")

    def listens(self, name):
        if Path(__file__).with_name("begin").exists():
            print("at work", flush=True)
            while True:
                pass
        return True
"""


def test_ctrl_c_ends_a_viewer_whose_frame_loop_never_returns(
    start: Callable[..., Program], tmp_path: Path
) -> None:
    plugin, config = tmp_path / "busy.py", tmp_path / "busy.yaml"
    plugin.write_text(BUSY)
    config.write_text("version: 1\ndisplays: [{type: Busy}]\n")
    program = start("webviz", "-d", str(config), "--plugin", str(plugin), "--port", "0")
    program.url()
    (tmp_path / "begin").touch()
    program.wait_for("at work")
    family = family_of(program)
    assert program.end(signal.SIGINT) == 1
    assert program.output().endswith("webviz: still busy after 3 s; exiting by force.\n")
    check_nothing_is_left(family)


def test_a_closed_pipe_is_not_an_error() -> None:
    command = f"{sys.executable} -m webviz schema | head -n 1"
    result = subprocess.run(command, shell=True, capture_output=True, text=True, timeout=60)
    assert result.stdout == "{\n"
    assert result.stderr == ""
