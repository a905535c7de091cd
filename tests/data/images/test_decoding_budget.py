"""Memory that decoding takes, for all threads."""

from __future__ import annotations

import contextlib
import gc
import struct
import subprocess
import sys
import threading

import numpy as np
import pytest

from webviz.data.images import ImageError, RawImage, decode_depth
from webviz.data.images.compressed_depth import HEADER
from webviz.data.memory import DECODING, MemoryBudget, OverBudgetError

THREE_AT_ONCE = """
import resource, struct, sys, threading
import numpy as np
from webviz.data.images import RawImage, Tone, compressed, decode_depth, render
from webviz.data.memory import MemoryBudget
from webviz.data.images.compressed_depth import HEADER

compressed.DECODING = MemoryBudget(int(sys.argv[2]) * 1_000_000)
EDGE = int(sys.argv[3])
if sys.argv[1] == "rvl":
    head = HEADER.pack(0, 100.0, 1.0) + struct.pack("<II", EDGE, EDGE)
    words = np.tile(np.frombuffer(bytes([0x11, 0x11, 0x11, 0x11]), np.uint8), EDGE * EDGE // 4)
    data = np.concatenate((np.frombuffer(head, np.uint8), words))
    decode = lambda: decode_depth("16UC1; compressedDepth rvl", data)[1].shape
else:
    values = np.linspace(0.0, 1.0, EDGE * EDGE, dtype=np.float32).view(np.uint8)
    image = RawImage(EDGE, EDGE, "32FC1", 4 * EDGE, False, values)
    decode = lambda: render(image, Tone(0.0, 1.0, "Turbo")).size
shapes = []
threads = [threading.Thread(target=lambda: shapes.append(decode())) for _ in range(3)]
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
[each.start() for each in threads]
[each.join() for each in threads]
assert shapes == [(EDGE, EDGE)] * 3, shapes
print((resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) // 1024)
"""


@pytest.mark.parametrize(("kind", "edge"), [("rvl", 1600), ("raw", 2400)])
def test_threads_that_decode_at_once_share_the_budget(kind: str, edge: int) -> None:
    arguments = [sys.executable, "-c", THREE_AT_ONCE, kind, "100", str(edge)]  # about 80 MB each
    run = subprocess.run(arguments, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    assert int(run.stdout) < 170  # MB; in turn they take 120, at once 240


def test_a_header_that_claims_more_than_the_budget_is_refused() -> None:
    claim = HEADER.pack(0, 100.0, 1.0) + struct.pack("<II", 8192, 8192) + bytes(100)
    data = np.frombuffer(claim, np.uint8)
    with pytest.raises(ImageError, match=r"8192 x 8192 pixels takes \d+ MB to decode; the limit"):
        decode_depth("16UC1; compressedDepth rvl", data)


def test_memory_is_given_back_after_an_error() -> None:
    broken = HEADER.pack(0, 100.0, 1.0) + struct.pack("<II", 4000, 4000) + bytes(100)
    for _ in range(5):
        with pytest.raises(ImageError, match="RVL"):
            decode_depth("16UC1; compressedDepth rvl", np.frombuffer(broken, np.uint8))
    with DECODING.take(DECODING.room):  # another test may have left something to the collector
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


class Owner:
    """Something that was loaded."""


def test_loaded_data_uses_the_budget_until_it_is_freed() -> None:
    budget = MemoryBudget(100_000_000, 40_000_000)
    owner = Owner()
    budget.hold(owner, 30_000_000)
    with pytest.raises(OverBudgetError, match="takes 20 MB of memory; 10 MB of 40 MB are left"):
        budget.hold(Owner(), 20_000_000)
    with (
        pytest.raises(OverBudgetError, match="the limit is 70 MB beside 30 MB already loaded"),
        budget.take(90_000_000),
    ):
        pass
    assert budget.is_scarce
    del owner
    gc.collect()
    with budget.take(100_000_000):
        assert not budget.is_scarce


def test_work_that_waits_learns_that_there_will_never_be_room() -> None:
    budget = MemoryBudget(100)
    refusal = threading.Event()
    is_tried = threading.Event()

    def other() -> None:
        is_tried.set()
        with contextlib.suppress(OverBudgetError), budget.take(90):
            return
        refusal.set()

    owner = Owner()
    with budget.take(60):
        thread = threading.Thread(target=other)
        thread.start()
        assert is_tried.wait(60)
        budget.hold(owner, 50)
    assert refusal.wait(60)
    thread.join()


def test_an_image_that_might_never_have_memory_is_refused_with_a_number() -> None:
    class Message:
        width = height = 8192
        encoding, step, is_bigendian, data = "64FC4", 0, 0, np.zeros(0, np.uint8)

    with pytest.raises(ImageError, match=r"64FC4 need more .* at most 9 million"):
        RawImage.of(Message())
