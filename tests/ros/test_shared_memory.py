"""Shared memory of killed processes is removed, that of running ones is kept."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from waiting import until

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install ros-webviz[ros]")
from webviz.ros.shared_memory import MIN_AGE_S, remove_abandoned, remove_unused, segments_of
from webviz.shell.testing.domain import isolated_domain

PROGRAM = """
from webviz.ros.node import RosSource
source = RosSource()
print("ready", flush=True)
input()
source.close()
"""


@pytest.fixture
def start() -> Iterator[Callable[[], subprocess.Popen[str]]]:
    """Start a program in a ROS domain of its own: those who meet open each other's segments."""
    with ExitStack() as stack:

        def start() -> subprocess.Popen[str]:
            stack.enter_context(isolated_domain())
            program = [sys.executable, "-c", PROGRAM]
            pipe = subprocess.PIPE
            process = stack.enter_context(
                subprocess.Popen(program, stdin=pipe, stdout=pipe, text=True)
            )
            stack.callback(process.kill)
            assert process.stdout is not None
            assert process.stdout.readline() == "ready\n"
            return process

        yield start


def files(process: subprocess.Popen[str]) -> set[Path]:
    """The segments of a process and their lock files."""
    maps = Path(f"/proc/{process.pid}/maps").read_text()
    segments = set(re.findall(r"/dev/shm/fast(?:rtps|dds)_[0-9a-f]{16}\b", maps))
    return {Path(segment + suffix) for segment in segments for suffix in ("", "_el")}


def existing(paths: set[Path]) -> set[Path]:
    return {path for path in paths if path.exists()}


def test_segments_of_killed_processes_are_removed_and_those_of_others_kept(
    start: Callable[[], subprocess.Popen[str]],
) -> None:
    running, killed = start(), start()
    own, abandoned = files(running), files(killed)
    assert own
    assert abandoned
    assert not own & abandoned
    killed.kill()
    killed.wait()
    for lock in abandoned:
        os.utime(lock)
    remove_abandoned()
    assert existing(abandoned) == abandoned  # they may be about to be locked
    for lock in abandoned | own:
        os.utime(lock, (0, lock.stat().st_mtime - MIN_AGE_S))
    remove_abandoned()
    # Another process may remove them at this moment, as each does that starts a node.
    until(lambda: not existing(abandoned))
    assert existing(own) == own
    running.communicate("\n")
    assert existing(own) == set()


def test_segments_of_a_process_that_is_killed_are_removed_at_once(
    start: Callable[[], subprocess.Popen[str]],
) -> None:
    running, killed = start(), start()
    own, abandoned = files(running), files(killed)
    segments = segments_of(killed.pid)
    assert {path for path in abandoned if not path.name.endswith("_el")} == segments
    killed.kill()
    killed.wait()
    remove_unused(segments | segments_of(running.pid) | segments_of(killed.pid))
    assert existing(abandoned) == set()
    assert existing(own) == own
    running.communicate("\n")
