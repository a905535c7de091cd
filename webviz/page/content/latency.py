"""Latencies of displays."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from webviz.engine.state import State
from webviz.page.content.store import PageStore


class ShownStage(msgspec.Struct, frozen=True):
    """A step of samples on their way, in seconds; see `webviz.engine.state.latency.Stage`."""

    name: str
    begin: float
    p50: float
    p99: float


class ShownLatency(msgspec.Struct, frozen=True):
    """The latency of a display, see `webviz.engine.state.latency.Latency`.

    Args:
        id, name: of the display.
    """

    id: str
    name: str
    samples: int
    stages: Sequence[ShownStage]
    p50: float
    p99: float
    waits_for: str
    core: float


class LatencyStore(PageStore, frozen=True):
    """The latencies of all displays that have drawn a sample while they were watched."""

    all: Sequence[ShownLatency]


def latency(state: State, _: str) -> LatencyStore:
    """Return the latencies, those of the slowest display first."""
    names = {row.id: row.name for row in state.rows}
    found = [
        ShownLatency(
            each.display,
            names.get(each.display, each.display),
            each.samples,
            [
                ShownStage(s.name, round(s.begin, 5), round(s.p50, 5), round(s.p99, 5))
                for s in each.stages
            ],
            round(each.p50, 4),
            round(each.p99, 4),
            each.waits_for,
            round(each.core, 4),
        )
        for each in state.latencies
    ]
    return LatencyStore(sorted(found, key=lambda each: -each.p50))
