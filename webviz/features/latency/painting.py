"""Times at which browsers paint what displays have drawn, and its cost on their links."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping

import numpy as np

from webviz.engine.forms import brief
from webviz.engine.pipeline.browsers import Browsers, Painted
from webviz.features.latency.stages import BrowserLatency, stages_of

SAMPLES = 200
"""Last samples of a display in a browser."""
EVERY_S = 0.1
"""Least interval between two probes."""
MAX_OPEN = 32
"""Probes that may still be answered."""

Spans = tuple[float, float, float]
"""Durations of a sample in seconds: until it was sent, then acknowledged, then painted."""


class Painting:
    """Probes browsers after samples were sent to them.

    Args:
        browsers: of the scene.
    """

    def __init__(self, browsers: Browsers) -> None:
        self._browsers = browsers
        self._probes: dict[int, tuple[float, Mapping[str, float]]] = {}
        """Times when samples were sent, and how long each took until then, by number and
        display."""
        self._spans: dict[tuple[str, int], deque[Spans]] = {}
        self._probed_s = -EVERY_S
        self._bytes: Mapping[int, Mapping[str, int]] = {}
        self._rates: dict[tuple[str, int], float] = {}
        self._names: Mapping[int, str] = {}

    def begin(self, is_wanted: bool) -> None:
        """Begin to measure, or end it."""
        self._browsers.count_bytes(is_wanted)
        self._bytes = {}
        self._rates.clear()
        self.clear()

    def clear(self) -> None:
        """Forget all samples."""
        self._probes.clear()
        self._spans.clear()

    def sent(self, ways_s: Mapping[str, float], at_s: float) -> None:
        """Ask when samples are painted that were sent at a monotonic time in seconds.

        Args:
            ways_s: the time that each took until then, by display.
            at_s: when they were sent.
        """
        if at_s - self._probed_s < EVERY_S:
            return
        self._probed_s = at_s
        self._probes[self._browsers.probe()] = at_s, ways_s
        while len(self._probes) > MAX_OPEN:
            del self._probes[next(iter(self._probes))]

    def take(self) -> None:
        """Take the answers that have arrived."""
        for answer in self._browsers.take_painted():
            self._note(answer)

    def measure(self, passed_s: float) -> None:
        """Measure the bytes of each display on each link since the last call."""
        self._names = {each.id: brief(each.name) for each in self._browsers.reports()}
        bytes_sent = self._browsers.bytes_sent()
        self._rates = {
            (display, browser): (size - self._bytes.get(browser, {}).get(display, 0)) / passed_s
            for browser, sizes in bytes_sent.items()
            if browser in self._names
            for display, size in sizes.items()
        }
        self._bytes = bytes_sent
        removed = [key for key in self._spans if key[1] not in self._names]
        for key in removed:
            del self._spans[key]

    def of(self, display: str) -> tuple[BrowserLatency, ...]:
        """Return the way of a display's samples to each browser."""
        return tuple(
            self._latency(display, browser, name)
            for browser, name in self._names.items()
            if (display, browser) in self._spans or (display, browser) in self._rates
        )

    def _note(self, answer: Painted) -> None:
        if answer.probe not in self._probes:
            return
        sent_s, ways_s = self._probes[answer.probe]
        acknowledged_s = max(0.0, answer.acknowledged_s - sent_s)
        painted_s = max(0.0, answer.painted_s - sent_s - acknowledged_s)
        for display, way_s in ways_s.items():
            spans = self._spans.setdefault((display, answer.browser), deque(maxlen=SAMPLES))
            spans.append((way_s, acknowledged_s, painted_s))

    def _latency(self, display: str, browser: int, name: str) -> BrowserLatency:
        rate = round(self._rates.get((display, browser), 0.0))
        spans = np.array(self._spans.get((display, browser), ()), dtype=np.float64)
        if not len(spans):
            return BrowserLatency(browser, name, (), 0.0, 0.0, rate)
        values = np.column_stack((spans[:, 1:], spans.sum(axis=1)))
        p50, p99 = np.percentile(values, (50, 99), axis=0, method="inverted_cdf").tolist()
        names = "acknowledged", "painted"
        stages = stages_of(names, (0.0, p50[0]), p50[:2], p99[:2])
        return BrowserLatency(browser, name, stages, round(p50[2], 4), round(p99[2], 4), rate)
