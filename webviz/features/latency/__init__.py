"""The latencies of displays, measured while a page shows them."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Mapping, Sequence, Set
from concurrent.futures import Future
from typing import Any

import numpy as np
from numpy.typing import NDArray

from webviz.api.errors import Error
from webviz.data.transforms import TransformBuffer
from webviz.data.transforms.tree import ancestors
from webviz.engine.feature import Feature, command, store
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.parts.part import PartContext
from webviz.engine.pipeline.runner import Runner
from webviz.engine.pipeline.trace import Trace, Tracer
from webviz.engine.store import PageStore
from webviz.features.latency.painting import Painting
from webviz.features.latency.stages import Latency, stages_of

SAMPLES = 200
"""Last samples of a display."""
MAX_DISPLAYS = 50
LONG_S = 0.002
"""Waiting for a transform that is reported."""
EVERY_S = 1.0
STAMPED_S = 3600.0
"""A stamp further from its arrival is of another clock."""


STEPS = ("received", "ready", "decoded", "drawn", "sent")
Times = tuple[int, int, int, int, int, int]
"""Times of a sample in ns: its stamp, and the end of each step."""


class LatencyStore(PageStore, frozen=True):
    """The latencies of all displays that have drawn a sample while they were watched."""

    all: Sequence[Latency]


class LatencyFeature(Feature):
    """Traces one sample of each display at a time, and nothing while no page shows it."""

    name = "Latency"
    module = "latency.js"

    def __init__(self, context: PartContext) -> None:
        super().__init__(context)
        self._is_wanted = False
        self._requests: dict[str, Future[Trace]] = {}
        self._traces: dict[str, deque[Times]] = {}
        self._cores: dict[str, float] = {}
        self._busy: Mapping[str, float] = {}
        self._painting = Painting(context.scene.browsers)
        self._latencies: tuple[Latency, ...] = ()
        self._shown_at = 0.0

    @property
    def _tracer(self) -> Tracer:
        return self.context.get(DisplaysPart).tracer

    def watched(self, stores: Set[str]) -> None:
        """Measure while a page shows the latencies."""
        self.inspect_latency(bool(stores))

    def update(self) -> None:
        """Measure the latencies, while a page shows them."""
        if not self._is_wanted:
            self._latencies = ()
            return
        runners = list(self.context.get(DisplaysPart).list.active())[:MAX_DISPLAYS]
        self._collect([runner.id for runner in runners])
        self.context.boundary("Scene", self._painting.take)
        now = time.monotonic()
        if now - self._shown_at >= EVERY_S:
            self._measure(runners, now - self._shown_at)
            self.context.boundary("Scene", self._painting.measure, now - self._shown_at)
            self._shown_at = now
            self._latencies = tuple(
                self._latency(each) for each in runners if each.id in self._traces
            )

    def state(self) -> Mapping[str, Any]:
        """Return the latencies of displays."""
        return {"latencies": self._latencies}

    @store()
    def latency(self, argument: str) -> LatencyStore:
        """Return the latencies, those of the slowest display first."""
        return LatencyStore(sorted(self._latencies, key=lambda each: -each.p50))

    def reset(self) -> None:
        """Forget all traces: time has jumped."""
        self._traces.clear()
        self._painting.clear()
        self._latencies = ()

    @command(None)
    def inspect_latency(self, is_wanted: bool = True) -> None:
        """Trace samples of all displays while a page shows their latencies."""
        if is_wanted == self._is_wanted:
            return
        self._is_wanted = is_wanted
        tracer = self._tracer
        tracer.on_sent = self._note_traces
        tracer.time(self.name, is_wanted)
        self._shown_at = time.monotonic()
        self._busy = dict(tracer.busy_s)
        self.context.boundary("Scene", self._painting.begin, is_wanted)
        if not is_wanted:
            for answer in self._requests.values():
                answer.cancel()
            self._requests.clear()
            self._cores.clear()
            self.reset()

    def _note_traces(self, traces: Mapping[str, Trace], at_s: float) -> None:
        if self._is_wanted:
            ways_s = {display: _way_s(trace) for display, trace in traces.items()}
            self.context.boundary("Scene", self._painting.sent, ways_s, at_s)

    def _collect(self, displays: Sequence[str]) -> None:
        """Keep the traces that are complete, and ask for the next ones."""
        for display in [display for display in self._requests if display not in displays]:
            self._requests.pop(display).cancel()
            self._traces.pop(display, None)
        for display in displays:
            trace = self._requests.get(display)
            if trace is not None and trace.done():
                times = self._traces.setdefault(display, deque(maxlen=SAMPLES))
                times.append(_times(trace.result()))
                trace = None
            if trace is None:
                answer = self._requests[display] = Future[Trace]()
                try:
                    self._tracer.ask(display, answer)
                except Error:  # too many; perhaps next time
                    del self._requests[display]

    def _measure(self, runners: Sequence[Runner], passed_s: float) -> None:
        """Measure the share of a processor that each display took since the last time."""
        busy = dict(self._tracer.busy_s)
        for runner in runners:
            used = busy.get(runner.id, 0.0) - self._busy.get(runner.id, 0.0)
            self._cores[runner.id] = max(0.0, used) / passed_s
        self._busy = busy

    def _latency(self, runner: Runner) -> Latency:
        times = np.array(self._traces[runner.id], dtype=np.int64)
        ages_s = (times[:, 1] - times[:, 0]) / 1e9
        # A stamp of another clock, or none, says nothing about the way.
        is_stamped = bool(np.all((times[:, 0] > 0) & (np.abs(ages_s) < STAMPED_S)))
        times = times if is_stamped else times[:, 1:]
        spans = np.diff(times, axis=1) / 1e9
        p50, p99 = percentiles(spans)
        begins = np.cumsum(p50) - p50
        names = STEPS[-spans.shape[1] :]
        stages = stages_of(names, begins.tolist(), p50, p99)
        (whole_p50,), (whole_p99,) = percentiles(np.sum(spans, axis=1, keepdims=True))
        waited = next((stage.p50 for stage in stages if stage.name == "ready"), 0.0)
        frames = [each.frame for each in runner.observed() if each.frame]
        waits_for = ""
        if waited >= LONG_S and frames:
            link = slowest_link(self.context.buffer, self.context.frames.fixed_frame, frames[0])
            waits_for = f"Waits {1000 * waited:.0f} ms for {link}." if link else ""
        return Latency(
            runner.id,
            runner.display.name or type(runner.display).__name__,
            len(times),
            stages,
            round(whole_p50, 4),
            round(whole_p99, 4),
            waits_for,
            round(self._cores.get(runner.id, 0.0), 4),
            self._painting.of(runner.id),
        )


def percentiles(spans: NDArray[np.float64]) -> tuple[list[float], list[float]]:
    """Return the medians and 99th percentiles of columns, float64 (N, M): values that occurred."""
    p50, p99 = np.percentile(spans, (50, 99), axis=0, method="inverted_cdf").tolist()
    return p50, p99


def _way_s(trace: Trace) -> float:
    """Return the time from a stamp, or the arrival if the stamp is of another clock, to sending."""
    is_stamped = abs(trace.received_ns - trace.published_ns) < STAMPED_S * 1e9
    return (trace.sent_ns - (trace.published_ns if is_stamped else trace.received_ns)) / 1e9


def _times(trace: Trace) -> Times:
    return (
        trace.published_ns,
        trace.received_ns,
        trace.ready_ns,
        trace.decoded_ns,
        trace.drawn_ns,
        trace.sent_ns,
    )


def slowest_link(buffer: TransformBuffer, target: str, source: str) -> str:
    """Return the link whose newest transform is oldest between two frames, in words.

    "" without any.

    It decides on the newest time at which the source has a pose in the target.
    """
    tree = buffer.tree
    above, below = (ancestors(tree, each.removeprefix("/")) for each in (target, source))
    common = {*above} & {*below}
    chain = [frame for frame in (*above, *below) if frame not in common]
    moving = [
        (cache.newest_stamp, child, cache)
        for child in chain
        if (cache := tree.caches.get(child)) and cache.newest and cache.newest_stamp
    ]
    if not moving:
        return ""
    newest, child, cache = min(moving, key=lambda each: each[0])
    assert cache.newest is not None
    spanned_s = (newest - cache.oldest_stamp) / 1e9
    rate = f" at {(len(cache) - 1) / spanned_s:.0f} Hz" if spanned_s > 0 else ""
    return f"{cache.newest[1]} to {child}{rate}"
