"""Estimates of what a bridge drops."""

from __future__ import annotations

import pytest

from webviz.sources.bridge.backlog import WINDOW_S, LinkDelay, TopicBacklog


def test_the_fastest_message_has_no_delay_with_any_clocks() -> None:
    delay = LinkDelay()
    assert delay.note(1000.0, 5.0) == 0.0
    assert delay.note(1001.0, 6.5) == pytest.approx(0.5)
    assert delay.note(1002.0, 6.9) == 0.0
    # Clocks drift: what was the fastest a minute ago no longer counts.
    assert delay.note(1002.0 + 2 * WINDOW_S, 7.5 + 2 * WINDOW_S) == 0.0


def test_gaps_count_as_dropped_only_while_messages_are_late() -> None:
    backlog = TopicBacklog()
    for i in range(20):
        backlog.note(i * 0.1, 0.0)
    backlog.note(5.0, 0.1)  # the publisher paused
    assert backlog.dropped == 0
    backlog.note(5.1, 2.0)
    backlog.note(6.1, 2.5)
    assert backlog.dropped == 9
    assert backlog.delay_s == 2.5


def test_stamps_that_repeat_or_go_back_are_not_a_gap() -> None:
    backlog = TopicBacklog()
    for stamp_s in [1.0, 1.0, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 0.1, 0.1]:
        backlog.note(stamp_s, 3.0)
    assert backlog.dropped == 0
