"""Buffers keep and answer what tf2 does, whatever the order, the stamps and the kind of inserts.

The reference is tf2's storage as its rules say, on plain lists and without any of the buffer's
shortcuts: samples are pruned by the newest stamp first, then the new one is refused or kept.
"""

import random
from contextlib import suppress

import numpy as np
import pytest

from webviz.data.transforms import TransformBuffer, TransformException
from webviz.data.transforms.cache import TimeCache
from webviz.features.what_if import pin, unpin

S = 1_000_000_000
CACHE_NS = 10 * S
FRAMES = [f"f{i}" for i in range(1, 6)]
UNIT = (0.0, 0.0, 0.0, 1.0)


class Storage:
    """One frame of tf2's BufferCore, samples (stamp, parent, x) from the newest to the oldest."""

    def __init__(self, is_static: bool) -> None:
        self.is_static = is_static
        self.samples: list[tuple[int, str, float]] = []

    def insert(self, sample: tuple[int, str, float]) -> bool:
        if self.is_static:
            self.samples = [sample]
            return True
        latest = self.samples[0][0] if self.samples else 0
        while self.samples and self.samples[-1][0] < latest - CACHE_NS:
            self.samples.pop()
        if self.samples and sample[0] < latest - CACHE_NS:
            return False
        if sample in self.samples:
            return True
        later = sum(other[0] > sample[0] for other in self.samples)
        self.samples.insert(later, sample)
        return True

    def at(self, stamp: int) -> tuple[str, float] | None:
        samples = self.samples
        if not samples or self.is_static or stamp in (0, samples[0][0]):
            return samples[0][1:] if samples else None
        if stamp == samples[-1][0]:
            return samples[-1][1:]
        before = [sample for sample in samples if sample[0] <= stamp]
        after = [sample for sample in samples if sample[0] > stamp]
        if not before or not after:
            return None
        (t0, parent, a), (t1, other, b) = before[0], after[-1]
        return parent, a + (b - a) * (stamp - t0) / (t1 - t0) if parent == other else a


class Reference:
    """Several frames, none of which is the parent of another."""

    def __init__(self) -> None:
        self.frames: dict[str, Storage] = {}

    def insert(self, child: str, sample: tuple[int, str, float], is_static: bool) -> bool:
        storage = self.frames.get(child)
        if storage is None or storage.is_static != is_static:
            storage = self.frames[child] = Storage(is_static)
        return storage.insert(sample)

    def clear(self) -> None:
        for storage in self.frames.values():
            if not storage.is_static:
                storage.samples.clear()


@pytest.mark.parametrize("seed", range(40))
def test_a_buffer_equals_that_of_tf2(seed: int) -> None:
    dice = random.Random(seed)
    buffer, reference = TransformBuffer(CACHE_NS), Reference()
    start = dice.choice([0, 0, S, 1_700_000_000 * S])
    now, refusals = start, 0
    lists = [[(dice.choice("ab"), name) for name in FRAMES] for _ in range(3)]

    def stamp() -> int:
        """Mostly a little later; also zero, repeated, too old, at the edge, and far ahead."""
        nonlocal now
        now += dice.choice([S // 10, S // 10, S // 10, S, 0, 0, dice.choice([0, 100 * S])])
        back = [S // 20, S, CACHE_NS, CACHE_NS + 1, CACHE_NS - 1, 20 * S, 100 * S]
        return dice.choice([now, now, now, max(now - dice.choice(back), 0), dice.choice([0, now])])

    for _ in range(300):
        match dice.randrange(12):
            case 0 | 1 | 2 | 3 | 4:
                names = dice.choice(lists)
                same = stamp()
                stamps = [same if dice.random() < 0.9 else stamp() for _ in names]
                xs = [float(dice.randrange(3)) for _ in names]
                rows = np.array([[x, 0.0, 0.0, *UNIT] for x in xs])
                buffer.set_moving(names, stamps, rows, "a", 0)
                for (parent, child), ns, x in zip(names, stamps, xs, strict=True):
                    refusals += not reference.insert(child, (ns, parent, x), False)
            case 5 | 6 | 7 | 8 | 9:
                parent, child, ns = dice.choice("aab"), dice.choice(FRAMES), stamp()
                x, is_static = float(dice.randrange(3)), dice.random() < 0.03
                stored = buffer.set_transform(parent, child, ns, (x, 0.0, 0.0), UNIT, is_static)
                assert stored == reference.insert(child, (ns, parent, x), is_static)
            case 10 if dice.random() < 0.05:
                buffer.clear()
                reference.clear()
            case 11:
                pinned = dice.choice(FRAMES)
                pin(buffer, pinned, (9.0, 0.0, 0.0, *UNIT))
                unpin(buffer, pinned)
        assert_same(buffer, reference, dice, now)
    assert refusals


def assert_same(
    buffer: TransformBuffer, reference: Reference, dice: random.Random, now: int
) -> None:
    """Compare some frames: what is kept, and answers at times around what is kept."""
    for child in dice.sample(sorted(reference.frames), min(2, len(reference.frames))):
        storage, cache = reference.frames[child], buffer.tree.caches[child]
        if isinstance(cache, TimeCache):
            assert list(cache.stamps) == [sample[0] for sample in reversed(storage.samples)]
            assert list(cache.parents) == [sample[1] for sample in reversed(storage.samples)]
        for ns in (0, now, (now - 1) // 2, now - dice.randrange(20 * S), now - CACHE_NS):
            answers = {}
            for parent in "ab":
                with suppress(TransformException):  # without can_transform, which remembers nothing
                    answers[parent] = buffer.lookup(parent, child, ns).translation[0]
            expected = storage.at(ns)
            assert answers == pytest.approx({} if expected is None else dict([expected]))
