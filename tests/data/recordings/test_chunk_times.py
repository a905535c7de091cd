"""Chunks of an MCAP file by channels and time."""

from __future__ import annotations

import random

import pytest

from webviz.data.recordings.mcap import ChunkTimes
from webviz.data.recordings.mcap_chunks import McapChunk, counts_of

NEVER_NS = 2**64 - 1


def chunk(chance: random.Random, number: int) -> McapChunk:
    """A chunk of some of five channels, or of unknown ones."""
    start_ns = chance.randrange(100)
    end_ns = NEVER_NS if chance.random() < 0.05 else start_ns + chance.randrange(20)
    channels = chance.sample(range(5), chance.randrange(1, 4))
    counts = None if chance.random() < 0.1 else counts_of((each, 1) for each in channels)
    return McapChunk(number, 1, 1, 0, "", start_ns, end_ns, counts)


@pytest.mark.parametrize("seed", range(5))
def test_the_chunks_that_a_look_at_each_would_find(seed: int) -> None:
    chance = random.Random(seed)
    chunks = sorted((chunk(chance, n) for n in range(60)), key=lambda each: each.start_ns)
    times = ChunkTimes(chunks)
    for _ in range(50):
        expected = set(chance.sample(range(6), chance.randrange(4)))
        start_ns, end_ns = chance.randrange(-20, 120), chance.randrange(-20, 120)
        truth = {
            index
            for index, each in enumerate(chunks)
            if each.start_ns <= end_ns
            and start_ns <= each.end_ns
            and (each.counts is None or expected & set(each.counts["channel"].tolist()))
        }
        forward = times.within(expected, start_ns, end_ns, 1)
        backward = times.within(expected, start_ns, end_ns, -1)
        assert set(forward) == set(backward) == truth
        assert len(forward) == len(backward) == len(truth)
        assert forward == sorted(forward)
        ends = [chunks[index].end_ns for index in backward]
        assert ends == sorted(ends, reverse=True)


def test_a_file_without_chunks_has_none() -> None:
    assert ChunkTimes([]).within({1}, 0, 10, 1) == []
