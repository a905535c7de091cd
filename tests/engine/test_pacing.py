"""The pace of the frame loop."""

import pytest

from webviz.engine.loop.turn import FramePacing


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
