"""The pace of the frame loop."""

from __future__ import annotations

import threading

import pytest

from webviz.engine.loop.turn import FramePacing


class TimedEvent(threading.Event):
    """An event whose `wait` lets simulated time pass.

    Args:
        arrivals_s: when something arrives, in seconds.
    """

    def __init__(self, *arrivals_s: float) -> None:
        super().__init__()
        self.now_s = 0.0
        self.waits_s: list[float] = []
        self._arrivals_s = list(arrivals_s)

    def wait(self, timeout: float | None = None) -> bool:
        """Let the time pass until something arrives, at most for `timeout` seconds."""
        assert timeout is not None
        before_s, self.now_s = self.now_s, self.now_s + timeout
        if arrives := bool(self._arrivals_s and self._arrivals_s[0] <= self.now_s):
            self.now_s = self._arrivals_s.pop(0)
        self.waits_s.append(self.now_s - before_s)
        return arrives


def test_after_a_rest_two_turns_may_follow_at_once_and_the_next_one_waits() -> None:
    pace = FramePacing()
    pace.begin(100.0, 0.02)
    assert pace.rest(100.001) == 0.0
    pace.begin(100.001, 0.02)
    assert pace.rest(100.002) == pytest.approx(0.018)


def test_without_a_rest_there_is_one_turn_per_period() -> None:
    pace, now, turns = FramePacing(), 100.0, 0
    while now < 101.0:
        pace.begin(now, 0.02)
        now += 0.001 + pace.rest(now + 0.001)
        turns += 1
    assert turns == pytest.approx(50, abs=2)


def test_the_longer_nothing_arrives_the_longer_is_the_interval_up_to_four_seconds() -> None:
    arrived = TimedEvent(60.0)
    pace = FramePacing(lambda: arrived.now_s)
    while arrived.now_s < 65.0:
        pace.wait(arrived)
    first, last = arrived.waits_s[:10], arrived.waits_s[-5:]
    assert first == pytest.approx([1.0] * 10)
    assert max(arrived.waits_s) == pytest.approx(4.0)
    assert last == pytest.approx([1.0] * 5)  # what arrived at 60 s began it anew
