"""Merging the samples of a display with its hook `fold`."""

from __future__ import annotations

import copy
from collections import Counter, deque
from collections.abc import Iterator
from concurrent.futures import Future
from dataclasses import dataclass, replace
from typing import Any

from webviz.api.display import Display
from webviz.api.sample import Sample
from webviz.engine.pipeline.background import Workers, is_slow
from webviz.engine.pipeline.guard import CRASHED, Guard
from webviz.engine.sources import Raw

MAX_BYTES = 64 << 20
"""Of messages that wait while another is merged; the newest waits however large it is."""


@dataclass(frozen=True)
class Received:
    """A decoded message, or a set of them.

    Args:
        sample: with the message.
        size: of its messages, in bytes.
        raw: the message as it arrived.
        ready_s, decoded_s: monotonic times, in seconds.
    """

    sample: Sample
    size: int
    raw: Raw
    ready_s: float
    decoded_s: float


class Folding:
    """Merges samples in order. A large one is merged in a worker, and later ones wait for it.

    Args:
        workers: for large messages.
    """

    def __init__(self, workers: Workers) -> None:
        self.dropped: Counter[str] = Counter()
        """How many samples of each input could not wait."""
        self._workers = workers
        self._state: Any = None
        self._waiting: deque[Received] = deque()
        self._work: tuple[Received, Future[Any]] | None = None

    @property
    def busy_with(self) -> Received | None:
        """What is merged in a worker."""
        return self._work and self._work[0]

    def put(self, received: Received) -> None:
        """Add a sample; `results` has it once it is merged."""
        self._waiting.append(received)
        size = sum(each.size for each in self._waiting)
        while len(self._waiting) > 1 and size > MAX_BYTES and self._work:
            oldest = self._waiting.popleft()
            size -= oldest.size
            self.dropped[oldest.sample.input] += 1

    def results(self, display: Display, guard: Guard) -> Iterator[Received]:
        """What was merged since the last call, with the merged message in the sample."""
        while self._work or self._waiting:
            if self._work is None:
                received = self._waiting.popleft()
                args = received.sample.input, received.sample, self._state
                if is_slow(display, received.size):
                    work = self._workers.submit(copy.copy(display).fold, *args)
                    self._work = received, work
                    return
                folded = guard("fold", display.fold, *args)
            else:
                received, work = self._work
                if not work.done():
                    return
                self._work = None
                folded = guard("fold", work.result)
            if folded is not None and folded is not CRASHED:
                self._state = folded
                yield replace(received, sample=replace(received.sample, message=folded))
