"""Clocks of bridges, compared with that of this machine."""

from __future__ import annotations

import random

import pytest

from webviz.sources.bridge.clock import TOLERANCE_NS, BridgeClock

S = 1_000_000_000
NOW = 1_700_000_000 * S


def run(clock: BridgeClock, ahead_s: float, seconds: float, start_ns: int = NOW) -> int:
    """Let messages come at 20 Hz that take 30 ms or more; the time after them."""
    chance = random.Random(1)
    for i in range(round(seconds * 20)):
        sent_ns = start_ns + i * S // 20
        late_ns = round((0.03 + chance.expovariate(10)) * S)
        clock.note(sent_ns + round(ahead_s * S), sent_ns + late_ns)
    return start_ns + round(seconds * S)


@pytest.mark.parametrize("ahead_s", [-3600.0, -2.0, 0.2, 5.0, 1e6])
def test_the_difference_is_known_from_the_fastest_message(ahead_s: float) -> None:
    clock = BridgeClock()
    clock.note_trip(0.2)
    clock.note_trip(0.06)
    run(clock, ahead_s, 2.0)
    assert clock.ahead_ns / 1e9 == pytest.approx(ahead_s, abs=0.06)


def test_the_first_message_counts_already() -> None:
    clock = BridgeClock()
    clock.note(NOW + 3 * S, NOW)
    assert clock.ahead_ns == 3 * S


def test_clocks_that_agree_are_not_corrected() -> None:
    clock = BridgeClock()
    clock.note_trip(0.06)
    run(clock, 0.02, 5.0)
    assert clock.ahead_ns == 0


def test_a_clock_that_drifts_or_is_set_is_followed_in_steps() -> None:
    clock = BridgeClock()
    clock.note_trip(0.06)
    now_ns = run(clock, 1.0, 5.0)
    before_ns = clock.ahead_ns
    now_ns = run(clock, 1.0 + TOLERANCE_NS / 4e9, 5.0, now_ns)
    assert clock.ahead_ns == before_ns
    now_ns = run(clock, 2.0, 1.0, now_ns)
    assert clock.ahead_ns / 1e9 == pytest.approx(2.0, abs=0.06)
    # Set back: the fast messages of before count for a minute.
    run(clock, -1.0, 70.0, now_ns)
    assert clock.ahead_ns / 1e9 == pytest.approx(-1.0, abs=0.06)
