"""Memory of large messages, returned once they stop."""

from __future__ import annotations

import subprocess
import sys

import pytest

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install ros-webviz[ros]")

from webviz.ros.heap import MAX_UNUSED

PROGRAM = """
import itertools, psutil, sys
from webviz.ros.heap import PERIOD_S, Heap

def resident():
    return psutil.Process().memory_info().rss

heap = Heap(itertools.count(0.0, PERIOD_S).__next__)
messages = [b"x" * (16 << 20) for _ in range(int(sys.argv[1]))]
pin = [bytes(1000) for _ in range(1000)]
for message in messages:
    heap.note(len(message))
message = messages.clear()
loaded = resident()
heap.turn()
while_they_come = resident()
heap.turn()
print(loaded - while_they_come, loaded - resident())
"""


pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="is about glibc")


def returned(messages: int) -> tuple[int, int]:
    """Bytes that are returned of messages of 16 MB, while they come and in all."""
    program = [sys.executable, "-c", PROGRAM, str(messages)]
    completed = subprocess.run(program, capture_output=True, text=True, check=True, timeout=60)
    while_they_come, in_all = map(int, completed.stdout.split())
    return while_they_come, in_all


def test_memory_of_large_messages_is_kept_while_they_come_and_given_back_when_they_stop() -> None:
    while_they_come, in_all = returned(8)
    assert while_they_come < 1 << 20
    assert in_all > 100 << 20


def test_much_free_memory_is_given_back_while_large_messages_come() -> None:
    while_they_come, _ = returned(24)
    assert while_they_come > MAX_UNUSED
