"""The share of a processor that the frame loop wants, and which display takes how much of it."""

from __future__ import annotations

import time
from collections.abc import Mapping
from pathlib import Path

from webviz.engine.pipeline.trace import Tracer

SCHEDULER = Path("/proc/thread-self/schedstat")
BUSY = 0.5
"""Above it, the displays are timed, too."""


class LoadMeter:
    """Measures between two calls in the thread of the frame loop.

    Args:
        tracer: times displays on request.
    """

    def __init__(self, tracer: Tracer) -> None:
        self._tracer = tracer
        self._before: tuple[float, float] | None = None
        self._busy: dict[str, float] = {}

    def measure(self) -> tuple[float, Mapping[str, float]]:
        """Return the shares since the last call: of the loop, and of each display if it is busy.

        Waiting for a processor that other programs have counts as well: it delays as much.
        """
        now, used = time.monotonic(), _wanted_s()
        before, self._before = self._before, (now, used)
        if before is None or now <= before[0]:
            return 0.0, {}
        passed = now - before[0]
        load = max(0.0, used - before[1]) / passed
        busy = dict(self._tracer.busy_s)
        cores = {
            display: (seconds - self._busy.get(display, 0.0)) / passed
            for display, seconds in busy.items()
            if seconds > self._busy.get(display, 0.0)
        }
        self._busy = busy
        self._tracer.time("load", load > BUSY)
        return load, cores


def _wanted_s() -> float:
    """Seconds for which this thread ran, or waited for a processor, since its start."""
    try:
        ran_ns, waited_ns, *_ = SCHEDULER.read_text().split()
        return (int(ran_ns) + int(waited_ns)) / 1e9
    except (OSError, ValueError):  # not on Linux
        return time.thread_time()
