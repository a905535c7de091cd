"""A recording, live topics and their past, as pages are sent them."""

from __future__ import annotations

import math

import pytest
from msgspec import UNSET
from msgspec.structs import replace

from webviz.api.status import Level
from webviz.features.playback.stores import (
    DensityStore,
    counted,
    density_store,
    events_of,
    playback_store,
)
from webviz.sources.past_state import Event, PlaybackState

S = 1_000_000_000
BAG = PlaybackState(
    names=("run",),
    start_ns=1000 * S,
    end_ns=1010 * S + S // 2,
    position_s=2.00049,
    rate=2.0,
    is_playing=True,
    is_seeking=False,
    loop=True,
    selected=(1.0, 3.0),
)
LIVE = replace(BAG, first_s=4.0006, is_live=True, is_memory=True, gap=(5.0, 6.0))


def test_a_bag_has_a_duration_and_a_position() -> None:
    store = playback_store(BAG, memory_s=60.0, wall_s=2000.0, leader=3)
    assert (store.start, store.duration, store.position, store.rate) == (1000.0, 10.5, 2.0, 2.0)
    assert (store.limit, store.ahead, store.memory_s, store.first) == (UNSET, UNSET, UNSET, UNSET)
    assert (store.gap, store.leader) == (UNSET, UNSET)


def test_as_fast_as_possible_is_a_rate_of_zero() -> None:
    assert playback_store(replace(BAG, rate=math.inf), 60.0, 2000.0).rate == 0


def test_live_topics_have_a_memory_and_the_offset_of_the_clocks() -> None:
    store = playback_store(LIVE, memory_s=60.0, wall_s=1018.2, leader=3)
    assert (store.limit, store.ahead, store.memory_s) == (60.0, 8, 6)
    assert (store.duration, store.position, store.leader) == (UNSET, UNSET, UNSET)


def test_the_past_of_live_topics_has_a_position_a_gap_and_who_looked_back() -> None:
    store = playback_store(replace(LIVE, is_live=False), 60.0, 1018.2, leader=3)
    assert (store.first, store.position, store.gap, store.leader) == (4.001, 2.0, (5.0, 6.0), 3)
    assert (store.ahead, store.memory_s) == (8, UNSET)


@pytest.mark.parametrize(
    ("recording", "span"),
    [(BAG, (0.0, 10.5)), (replace(BAG, counted=(3.0, 4.0)), (3.0, 4.0)), (None, (0.0, 0.0))],
)
def test_messages_are_counted_in_all_of_a_recording_or_a_span(
    recording: PlaybackState | None, span: tuple[float, float]
) -> None:
    assert counted(recording) == span
    assert density_store(recording, {"/a": [1, 2], "/b": [3, 4]}) == DensityStore([4, 6], *span)
    assert density_store(recording, {}) == DensityStore([], 0.0, 0.0)


def test_events_have_microseconds_from_the_start() -> None:
    event = Event(1001 * S + 234_567_891, Level.WARN, "/driver", "Too hot.")
    assert events_of([event], 1000 * S) == [(1.234568, "warn", "/driver: Too hot.")]
