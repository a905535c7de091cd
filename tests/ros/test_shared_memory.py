"""Shared memory of killed processes is removed, that of running ones is kept."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install webviz[ros]")
from webviz.edges.ros.shared_memory import MIN_AGE_S, remove_abandoned

PROGRAM = """
from webviz.edges.ros.node import RosSource
source = RosSource()
print("ready", flush=True)
input()
source.close()
"""


def start() -> subprocess.Popen[str]:
    program = [sys.executable, "-c", PROGRAM]
    process = subprocess.Popen(
        program, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "ready\n"
    return process


def files(process: subprocess.Popen[str]) -> set[Path]:
    """The segments of a process and their lock files."""
    maps = Path(f"/proc/{process.pid}/maps").read_text()
    segments = set(re.findall(r"/dev/shm/fastrtps_[0-9a-f]{16}\b", maps))
    return {Path(segment + suffix) for segment in segments for suffix in ("", "_el")}


def existing(paths: set[Path]) -> set[Path]:
    return {path for path in paths if path.exists()}


def test_segments_of_killed_processes_are_removed_and_those_of_others_kept(
    webviz_domain: int,
) -> None:
    running, killed = start(), start()
    kept, abandoned = files(running), files(killed)
    assert kept
    assert abandoned
    killed.kill()
    killed.communicate()
    remove_abandoned()
    assert existing(abandoned) == abandoned  # they may be about to be locked
    for lock in abandoned | kept:
        os.utime(lock, (0, lock.stat().st_mtime - MIN_AGE_S))
    remove_abandoned()
    assert existing(abandoned) == set()
    assert existing(kept) == kept
    running.communicate("\n", timeout=30)
    assert existing(kept) == set()
