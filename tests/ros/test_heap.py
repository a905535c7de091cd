"""Memory of large messages, returned once they stop."""

from __future__ import annotations

import subprocess
import sys

import pytest

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install webviz[ros]")

PROGRAM = """
import itertools, psutil
from webviz.edges.ros.heap import PERIOD_S, Heap

def resident():
    return psutil.Process().memory_info().rss

heap = Heap(itertools.count(0.0, PERIOD_S).__next__)
messages = [b"x" * (16 << 20) for _ in range(8)]
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


@pytest.mark.skipif(sys.platform != "linux", reason="is about glibc")
def test_memory_of_large_messages_is_kept_while_they_come_and_given_back_when_they_stop() -> None:
    program = [sys.executable, "-c", PROGRAM]
    done = subprocess.run(program, capture_output=True, text=True, check=True, timeout=60)
    kept, given_back = map(int, done.stdout.split())
    assert kept < 1 << 20
    assert given_back > 100 << 20
