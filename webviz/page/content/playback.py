"""The recording that is played, for the timeline."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from webviz.engine.state import State
from webviz.page.content.forms import brief, sendable
from webviz.sources.past_state import Event


def playback(state: State, _: str) -> Mapping[str, Any]:
    """The recording, or the memory of live topics; times in seconds from its start.

    "start": of the recording, in seconds since 1970. "rate": 0 is as fast as possible. "selected":
    first and last second to play, or None. Pages count by themselves how live topics go on: "ahead"
    is the wall time over that of recording, "held" and "limit" are seconds in memory.
    """
    recording = state.playback
    if recording is None:
        return {}
    duration_s = (recording.end_ns - recording.start_ns) / 1e9
    told = {
        "names": recording.names,
        "start": recording.start_ns / 1e9,
        "rate": 0 if math.isinf(recording.rate) else recording.rate,
        "is_playing": recording.is_playing,
        "loop": recording.loop,
        "selected": recording.selected,
        "is_live": recording.is_live,
    }
    position_s = round(recording.position_s, 3)
    if recording.is_live is None:
        return {**told, "duration": duration_s, "position": position_s}
    told["limit"] = state.settings.memory.seconds
    told["ahead"] = round(state.clock.wall_s - recording.start_ns / 1e9 - duration_s)
    if recording.is_live:
        return {**told, "held": round(duration_s - recording.first_s)}
    return {
        **told,
        "first": round(recording.first_s, 3),
        "position": position_s,
        "gap": recording.gap,
    }


def bookmarks(state: State, _: str) -> Mapping[str, Any]:
    """The bookmarks of this recording by name, in seconds from its start, in order."""
    recording = state.playback
    if recording is None:
        return {}
    start_s, end_s = recording.start_ns / 1e9, recording.end_ns / 1e9
    inside = [
        [sendable(name), round(at_s - start_s, 6)]
        for name, at_s in state.settings.bookmarks.items()
        if start_s <= at_s <= end_s
    ]
    return {"all": sorted(inside, key=lambda bookmark: bookmark[1])}


def density(state: State, _: str) -> Mapping[str, Any]:
    """Counts of all messages in equal parts of the recording."""
    counts = list(state.recorded.values())
    return {"counts": np.sum(counts, axis=0).tolist() if counts else []}


def recorded(state: State, _: str) -> Mapping[str, Any]:
    """Counts of messages in equal parts of the recording, by topic."""
    return state.recorded


def events(state: State, _: str) -> Mapping[str, Any]:
    """Warnings and errors in the recording, logged by nodes and of displays, each by time.

    Each is [seconds from the start, "warn" or "error", text].
    """
    recording = state.playback
    if recording is None:
        return {}
    start_ns = recording.start_ns
    return {
        "logged": [_event(event, start_ns) for event in state.logged],
        "displays": [_event(event, start_ns) for event in state.warned],
    }


def _event(event: Event, start_ns: int) -> Sequence[Any]:
    at_s = (event.at_ns - start_ns) / 1e9
    return [round(at_s, 6), event.level.name.lower(), brief(f"{event.name}: {event.text}")]
