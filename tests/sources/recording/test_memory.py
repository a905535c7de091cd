"""The memory of live topics while people look back, and what is kept of a moment."""

from __future__ import annotations

import math

from tests.sources.recording.messages import raw
from webviz.shell.testing.source import HandFedSource
from webviz.sources.recording import RecentMessages
from webviz.sources.recording.entries_history import WallClock
from webviz.sources.recording.memory import MAX_HELD_PARTS, LiveHistogram, MemoryHistory
from webviz.sources.recording.moment import MomentHistory


def test_a_moment_counts_messages_in_equal_parts() -> None:
    memory = MemoryHistory(HandFedSource())
    memory.recent.seconds, memory.recent.max_bytes = math.inf, 10**6
    for second, topic in enumerate(("/a", "/a", "/b", "/a", "/a")):
        memory.recent.put(topic, raw(10.0 + second))
    moment = MomentHistory(memory).prepared()
    assert moment.end_ns - moment.start_ns == 4 * 10**9
    assert moment.histogram(2) == {"/a": [2, 2], "/b": [0, 1]}
    assert moment.histogram(4) == {"/a": [1, 1, 0, 2], "/b": [0, 0, 1, 0]}


def test_counts_of_what_was_forgotten_meanwhile_are_held_up_to_a_limit() -> None:
    memory, clock = RecentMessages(lambda topic: 0, seconds=60.0, max_bytes=10**6), WallClock()
    histogram = LiveHistogram(memory, clock)
    memory.put("/a", raw(5000.5))
    histogram.hold()
    memory.put("/a", raw(5100.5))
    counts = histogram.counts(clock.stamp_ns(5102.0))["/a"]
    assert (len(counts), counts[0], counts[100], sum(counts)) == (102, 1, 1, 2)
    histogram.release()
    assert histogram.counts(clock.stamp_ns(5102.0))["/a"] == [1, 0]
    histogram.hold()
    late_s = 5100.0 + 2 * MAX_HELD_PARTS
    assert histogram.counts(clock.stamp_ns(late_s)) == {"/a": [0] * MAX_HELD_PARTS}
    assert histogram.span_ns[1] - histogram.span_ns[0] == MAX_HELD_PARTS * 10**9
