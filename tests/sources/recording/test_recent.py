"""The last minutes of what arrived, in memory."""

from __future__ import annotations

import time
from collections import Counter

import pytest

from tests.sources.recording.messages import raw
from webviz.data.messages import decode, encode
from webviz.sources import Raw
from webviz.sources.recording import RecentMessages, recent


def test_a_memory_drops_messages_over_its_seconds_and_bytes() -> None:
    memory = RecentMessages(lambda topic: 0, seconds=10.0, max_bytes=3000)
    for second in range(20):
        memory.put("/a", raw(second))
    assert [m.received_ns // 10**9 for _, m in memory.last(1e9).messages] == list(range(10, 20))
    memory.put("/big", raw(20, size=2500))
    assert [(t, m.received_ns // 10**9) for t, m in memory.last(1e9).messages] == [
        ("/a", 19),
        ("/big", 20),
    ]


def test_large_messages_do_not_leave_a_past_without_small_ones() -> None:
    now_s = time.monotonic()
    memory = RecentMessages(lambda topic: 0, seconds=60.0, max_bytes=10 * recent.LARGE_BYTES)
    for second in range(50):
        memory.put("/tf", raw(now_s - 50 + second, size=1000))
        memory.put("/points", raw(now_s - 50 + second, size=recent.LARGE_BYTES))
    past = memory.last(1e9).messages
    assert [topic for topic, _ in past].count("/tf") == 50
    assert [topic for topic, _ in past].count("/points") == 9
    assert [m.arrived_s for _, m in past] == sorted(m.arrived_s for _, m in past)
    assert memory.size()[1] <= 10 * recent.LARGE_BYTES
    topics, seconds = memory.cut() or ((), 0.0)
    assert topics == ("/points",)
    assert 9.0 <= seconds < 15.0
    assert memory.after(now_s - 2.5)[0][0] == "/tf"


def test_small_messages_beyond_their_share_make_room_for_large_ones() -> None:
    now_s, size = time.monotonic(), 10 * recent.LARGE_BYTES
    memory = RecentMessages(lambda topic: 0, seconds=60.0, max_bytes=size)
    for number in range(40):
        memory.put("/scan", raw(now_s - 8 + number / 10, size=recent.LARGE_BYTES // 2))
    assert memory.size()[1] > 0.9 * size, "alone they have all"
    for number in range(40):
        memory.put("/points", raw(now_s - 4 + number / 10, size=recent.LARGE_BYTES))
    topics = [topic for topic, _ in memory.last(1e9).messages]
    assert topics.count("/scan") * recent.LARGE_BYTES / 2 > (recent.SMALL_SHARE - 0.1) * size
    assert topics.count("/points") >= 7
    assert memory.is_full


def test_the_newest_latched_message_is_not_forgotten() -> None:
    memory = RecentMessages(lambda topic: int(topic == "/map"), seconds=10.0, max_bytes=10**6)
    memory.put("/map", raw(0))
    memory.put("/map", raw(1))
    memory.put("/scan", raw(2))
    memory.put("/scan", raw(100))
    past = memory.last(1e9)
    assert {topic: m.received_ns // 10**9 for topic, m in past.latched} == {"/map": 1}
    assert [topic for topic, _ in past.messages] == ["/scan"]


def test_latched_messages_are_forgotten_the_oldest_first_if_they_are_too_large_together(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(recent, "MAX_PINNED_BYTES", 2500)
    memory = RecentMessages(lambda topic: 1)
    for second, topic in enumerate(("/a", "/b", "/c", "/b")):
        memory.put(topic, raw(second, size=1000))
    assert memory.pinned() == ("/b", "/c")
    memory.put("/large", raw(9, size=9000))
    assert memory.pinned() == ("/large",)


def test_latched_messages_that_arrived_since_are_not_lost_with_the_memory_before_them() -> None:
    memory = RecentMessages(lambda topic: int(topic == "/map"), seconds=10.0, max_bytes=10**6)
    memory.put("/scan", raw(0))
    memory.put("/map", raw(1))
    memory.put("/scan", raw(100))
    assert [topic for topic, _ in memory.after(0.0)] == ["/map", "/scan"]
    assert [topic for topic, _ in memory.after(1.0)] == ["/scan"]


def test_latched_messages_that_just_fit_together_are_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(recent, "MAX_PINNED_BYTES", 2000)
    memory = RecentMessages(lambda topic: 1)
    for second, topic in enumerate(("/a", "/b")):
        memory.put(topic, raw(second, size=1000))
    assert memory.pinned() == ("/a", "/b")
    memory.put("/c", raw(2, size=1000))
    assert memory.pinned() == ("/b", "/c")


def test_static_transforms_of_all_publishers_are_kept() -> None:
    memory = RecentMessages(
        lambda topic: 2 * (topic == "/tf_static"), seconds=10.0, max_bytes=10**6
    )

    def static(child: str, x: float, at_s: float) -> None:
        transform = {"child_frame_id": child, "transform": {"translation": {"x": x}}}
        cdr = encode("tf2_msgs/msg/TFMessage", {"transforms": [transform]})
        memory.put("/tf_static", Raw(cdr, round(at_s * 1e9), at_s))

    for number, child in enumerate(("base", "laser", "base", "camera")):
        static(child, float(number), float(number))
    memory.put("/scan", raw(100))
    transforms = [
        decode("tf2_msgs/msg/TFMessage", r.cdr).transforms[0] for _, r in memory.last(1e9).latched
    ]
    assert [(t.child, t.translation[0]) for t in transforms] == [
        ("laser", 1.0),
        ("base", 2.0),
        ("camera", 3.0),
    ]


def test_a_memory_counts_messages_and_knows_its_size() -> None:
    now_s = time.monotonic()
    memory = RecentMessages(lambda topic: int(topic == "/map"), seconds=10.0, max_bytes=10**6)
    assert memory.is_on
    assert not RecentMessages(lambda topic: 0, seconds=0.0, max_bytes=10**6).is_on
    assert not RecentMessages(lambda topic: 0, seconds=10.0).is_on
    assert memory.size() == (0.0, 0)
    memory.put("/map", raw(now_s - 20.0, size=500))
    for age_s in (4.0, 2.0):
        memory.put("/a", raw(now_s - age_s, size=100))
    seconds, size = memory.size()
    assert 4.0 <= seconds < 8.0
    assert size == 500 + 2 * (100 + recent.OVERHEAD)
    part_s, counts = memory.counts()
    assert (part_s, counts.keys()) == (1.0, {"/a"})
    assert counts["/a"].total() == 2
    for memory.seconds in (1000.0, 500.0):
        part_s, counts = memory.counts()
        assert part_s == memory.seconds / recent.MAX_PARTS
        parts = [int((now_s - age_s) // part_s) for age_s in (4.0, 2.0)]
        assert counts["/a"] == Counter(parts)
