"""Memory that decoding takes, for all threads."""

from __future__ import annotations

import struct
import subprocess
import sys
import threading

import numpy as np
import pytest

from webviz.data.images import ImageError, decode_depth
from webviz.data.images.compressed_depth import HEADER
from webviz.data.memory import DECODING, MemoryBudget, OverBudgetError

THREE_AT_ONCE = """
import resource, struct, sys, threading
import numpy as np
from webviz.data.images import compressed, decode_depth
from webviz.data.memory import MemoryBudget
from webviz.data.images.compressed_depth import HEADER

compressed.DECODING = MemoryBudget(int(sys.argv[1]) * 1_000_000)
EDGE = 1600  # 77 MB each on the way
head = HEADER.pack(0, 100.0, 1.0) + struct.pack("<II", EDGE, EDGE)
words = np.tile(np.frombuffer(bytes([0x11, 0x11, 0x11, 0x11]), np.uint8), EDGE * EDGE // 4)
data = np.concatenate((np.frombuffer(head, np.uint8), words))
shapes = []
threads = [
    threading.Thread(
        target=lambda: shapes.append(decode_depth("16UC1; compressedDepth rvl", data)[1].shape)
    )
    for _ in range(3)
]
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
[each.start() for each in threads]
[each.join() for each in threads]
assert shapes == [(EDGE, EDGE)] * 3, shapes
print((resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) // 1024)
"""


def test_threads_that_decode_at_once_share_the_budget() -> None:
    arguments = [sys.executable, "-c", THREE_AT_ONCE, "100"]
    run = subprocess.run(arguments, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    assert int(run.stdout) < 170  # MB; in turn they take 120, at once 240


def test_what_claims_more_than_the_budget_is_refused_in_one_sentence() -> None:
    claim = HEADER.pack(0, 100.0, 1.0) + struct.pack("<II", 8192, 8192) + bytes(100)
    data = np.frombuffer(claim, np.uint8)
    with pytest.raises(ImageError, match=r"8192 x 8192 pixels takes \d+ MB to decode; the limit"):
        decode_depth("16UC1; compressedDepth rvl", data)


def test_memory_is_given_back_after_an_error() -> None:
    broken = HEADER.pack(0, 100.0, 1.0) + struct.pack("<II", 4000, 4000) + bytes(100)
    for _ in range(5):
        with pytest.raises(ImageError, match="RVL"):
            decode_depth("16UC1; compressedDepth rvl", np.frombuffer(broken, np.uint8))
    with DECODING.take(DECODING.total):
        pass


def test_a_thread_waits_for_another_and_never_for_itself() -> None:
    budget = MemoryBudget(100)
    done = threading.Event()

    def other() -> None:
        with budget.take(60):
            done.set()

    with budget.take(60):
        thread = threading.Thread(target=other)
        thread.start()
        with budget.take(60):
            assert not done.is_set()
    assert done.wait(60)
    thread.join()
    with pytest.raises(OverBudgetError), budget.take(101):
        pass
