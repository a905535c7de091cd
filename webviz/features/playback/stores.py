"""The recording that is played, as the timeline shows it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import ClassVar

import msgspec
import numpy as np
from msgspec.structs import replace

from webviz.engine.forms import brief, sendable
from webviz.engine.parts.status_lines import LevelName, level_name
from webviz.engine.store import PageStore
from webviz.sources.past_state import Event, PlaybackState


class PlaybackStore(PageStore, frozen=True):
    """The recording, or the memory of live topics; times in seconds from its start.

    Pages count by themselves how live topics go on.

    Args:
        names: of the recordings.
        start: of the recording, in seconds since 1970.
        rate: seconds of the recording per second; 0 is as fast as possible.
        is_playing: whether the position moves on.
        loop: whether the span starts over at its end.
        selected: first and last second to play, None for all.
        is_live: whether live topics are shown, None for a recording.
        is_memory: whether it is what live topics brought, not a bag.
        is_opened: whether a recording is shown in the place of live topics.
        limit: seconds that the memory keeps at most.
        ahead: wall time over that of recording.
        memory_s: seconds in memory, of live topics.
        first: of the memory, unset while it is live.
        duration: of a recording.
        position: unset while it is live.
        gap: see `webviz.sources.past_state.PlaybackState`.
        leader: the browser that looked back last, None for a program; unset while it is live.
    """

    names: Sequence[str]
    start: float
    rate: float
    is_playing: bool
    loop: bool
    selected: tuple[float, float] | None
    is_live: bool | None
    is_memory: bool
    is_opened: bool
    limit: float | msgspec.UnsetType = msgspec.UNSET
    ahead: float | msgspec.UnsetType = msgspec.UNSET
    memory_s: float | msgspec.UnsetType = msgspec.UNSET
    first: float | msgspec.UnsetType = msgspec.UNSET
    duration: float | msgspec.UnsetType = msgspec.UNSET
    position: float | msgspec.UnsetType = msgspec.UNSET
    gap: tuple[float, float] | msgspec.UnsetType | None = msgspec.UNSET
    leader: int | msgspec.UnsetType | None = msgspec.UNSET


class BookmarksStore(PageStore, frozen=True):
    """The bookmarks of the recording: names, and seconds from its start, in order."""

    all: Sequence[tuple[str, float]]


class DensityStore(PageStore, frozen=True):
    """Counts of all messages in equal parts of a span, none without a recording or memory.

    Args:
        counts: by part.
        first, last: seconds of the span, 0 without counts.
    """

    counts: Sequence[int]
    first: float
    last: float


class RecordedStore(PageStore, frozen=True):
    """Counts of messages in equal parts of the recording, by topic."""

    spread: ClassVar = {"counts": ""}

    counts: Mapping[str, Sequence[int]]


LoggedEvent = tuple[float, LevelName, str]
"""Seconds from the start, level, and text."""


class EventsStore(PageStore, frozen=True):
    """Warnings and errors: logged by nodes, of displays and of the doctor, each by time."""

    logged: Sequence[LoggedEvent]
    displays: Sequence[LoggedEvent]
    findings: Sequence[LoggedEvent]


def playback_store(
    recording: PlaybackState, memory_s: float, wall_s: float, leader: int | None = None
) -> PlaybackStore:
    """Return the recording or the memory.

    Args:
        recording: that is played.
        memory_s: seconds that the memory of live topics keeps at most.
        wall_s: wall time, in seconds since 1970.
        leader: the browser that looked back last.
    """
    duration_s = (recording.end_ns - recording.start_ns) / 1e9
    store = PlaybackStore(
        names=recording.names,
        start=recording.start_ns / 1e9,
        rate=0 if math.isinf(recording.rate) else recording.rate,
        is_playing=recording.is_playing,
        loop=recording.loop,
        selected=recording.selected,
        is_live=recording.is_live,
        is_memory=recording.is_memory,
        is_opened=recording.is_opened,
    )
    position_s = round(recording.position_s, 3)
    if recording.is_live is None:
        return replace(store, duration=duration_s, position=position_s)
    store = replace(
        store,
        limit=memory_s,
        ahead=round(wall_s - recording.start_ns / 1e9 - duration_s),
    )
    if recording.is_live:
        return replace(store, memory_s=round(duration_s - recording.first_s))
    first_s = round(recording.first_s, 3)
    gap = recording.gap
    return replace(store, first=first_s, position=position_s, gap=gap, leader=leader)


def bookmarks_store(recording: PlaybackState, bookmarks: Mapping[str, float]) -> BookmarksStore:
    """Return those of all bookmarks that are within a recording."""
    start_s, end_s = recording.start_ns / 1e9, recording.end_ns / 1e9
    inside = [
        (str(sendable(name)), round(at_s - start_s, 6))
        for name, at_s in bookmarks.items()
        if start_s <= at_s <= end_s
    ]
    return BookmarksStore(sorted(inside, key=lambda bookmark: bookmark[1]))


def density_store(
    recording: PlaybackState | None, recorded: Mapping[str, Sequence[int]]
) -> DensityStore:
    """Return counts of all messages, from those by topic."""
    counts = list(recorded.values())
    first_s, last_s = counted(recording) if counts else (0.0, 0.0)
    total = np.sum(counts, axis=0).tolist() if counts else []
    return DensityStore(total, round(first_s, 3), round(last_s, 3))


def counted(recording: PlaybackState | None) -> tuple[float, float]:
    """Return the first and last second of the counts."""
    if recording is None:
        return 0.0, 0.0
    return recording.counted or (0.0, (recording.end_ns - recording.start_ns) / 1e9)


def events_of(events: Sequence[Event], start_ns: int) -> list[LoggedEvent]:
    """Return events of a recording that starts then, in nanoseconds since 1970."""
    return [_event(event, start_ns) for event in events]


def _event(event: Event, start_ns: int) -> LoggedEvent:
    at_s = (event.at_ns - start_ns) / 1e9
    return round(at_s, 6), level_name(event.level), brief(f"{event.name}: {event.text}")
