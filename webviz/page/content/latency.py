"""Latencies of displays."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from webviz.engine.state import State
from webviz.engine.state.latency import Stage
from webviz.engine.store import PageStore
from webviz.page.content.forms import brief


class ShownStage(msgspec.Struct, frozen=True):
    """A step of samples on their way, in seconds; see `webviz.engine.state.latency.Stage`."""

    name: str
    begin: float
    p50: float
    p99: float


class ShownBrowserLatency(msgspec.Struct, frozen=True):
    """The way to one browser, see `webviz.engine.state.latency.BrowserLatency`."""

    browser: int
    name: str
    stages: Sequence[ShownStage]
    p50: float
    p99: float
    bytes_per_s: float


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
    browsers: Sequence[ShownBrowserLatency]


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
            _stages(each.stages),
            round(each.p50, 4),
            round(each.p99, 4),
            each.waits_for,
            round(each.core, 4),
            [
                ShownBrowserLatency(
                    to.browser,
                    brief(to.name),
                    _stages(to.stages),
                    round(to.p50, 4),
                    round(to.p99, 4),
                    round(to.bytes_per_s),
                )
                for to in each.browsers
            ],
        )
        for each in state.latencies
    ]
    return LatencyStore(sorted(found, key=lambda each: -each.p50))


def _stages(stages: Sequence[Stage]) -> Sequence[ShownStage]:
    return [ShownStage(s.name, round(s.begin, 5), round(s.p50, 5), round(s.p99, 5)) for s in stages]
