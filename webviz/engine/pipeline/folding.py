"""Merging the samples of a display with its hook `fold`."""

from __future__ import annotations

import copy
import dataclasses
from collections import Counter, deque
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from typing import Any

import msgspec
from msgspec.structs import replace

from webviz.api.display import Display
from webviz.api.sample import Sample
from webviz.data.messages import MessageError, decode
from webviz.engine.error_boundary import CRASHED, ErrorBoundary
from webviz.engine.pipeline.background import Workers, is_slow
from webviz.sources import Raw

MAX_BYTES = 64 << 20
"""Limit in bytes of messages that wait while another is merged; the newest waits however large it
is."""


class Received(msgspec.Struct, frozen=True):
    """A message, or a set of them.

    Args:
        sample: with the decoded message, or with None to decode `raw` when it is merged.
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
    """Decodes and merges samples in order; those after one that a worker has wait.

    Large ones are decoded in a worker, and also merged there by displays that are threaded.

    Args:
        workers: for large messages.
        judged: called with an input and why its message is invalid, or "" if it is valid.
    """

    def __init__(self, workers: Workers, judged: Callable[[str, str], None]) -> None:
        self.dropped: Counter[str] = Counter()
        """Number of samples of each input that could not wait."""
        self._workers = workers
        self._judged = judged
        self._state: Any = None
        self._waiting: deque[Received] = deque()
        self._work: tuple[Received, Future[Any]] | None = None

    @property
    def busy_with(self) -> Received | None:
        """Return the message that a worker decodes or merges."""
        return self._work and self._work[0]

    @property
    def state(self) -> Any:
        """Return what was merged so far, None before the first sample."""
        return self._state

    def put(self, received: Received) -> None:
        """Add a sample; `results` has it once it is merged."""
        self._waiting.append(received)
        size = sum(each.size for each in self._waiting)
        while len(self._waiting) > 1 and size > MAX_BYTES and self._work:
            oldest = self._waiting.popleft()
            size -= oldest.size
            self.dropped[oldest.sample.input] += 1

    def results(self, display: Display, boundary: ErrorBoundary) -> Iterator[Received]:
        """Return the samples merged since the last call, with the merged message."""
        while self._work or self._waiting:
            if self._work is None:
                received = self._waiting.popleft()
                if is_slow(display, received.size):
                    args = copy.copy(display), received, self._state
                    self._work = received, self._workers.submit(_merged, *args)
                    return
                if received.sample.message is None and received.size >= display.slow_bytes:
                    self._work = received, self._workers.submit(_decoded, received)
                    return
                folded = boundary("fold", _merged, display, received, self._state)
            else:
                received, work = self._work
                if not work.done():
                    return
                self._work = None
                folded = boundary("fold", work.result)
                if isinstance(folded, Received):
                    folded = boundary("fold", _merged, display, folded, self._state)
            refusal = str(folded) if isinstance(folded, MessageError) else ""
            self._judged(received.sample.input, refusal)
            if folded is not None and folded is not CRASHED and not refusal:
                self._state = folded
                yield replace(received, sample=dataclasses.replace(received.sample, message=folded))


def _merged(display: Display, received: Received, state: Any) -> Any:
    """Return the state with a sample merged into it, or why its message is invalid."""
    decoded = _decoded(received)
    if isinstance(decoded, MessageError):
        return decoded
    return display.fold(decoded.sample.input, decoded.sample, state)


def _decoded(received: Received) -> Received | MessageError:
    """Return a sample with its message, or why that is invalid."""
    sample = received.sample
    if sample.message is not None:
        return received
    try:
        message = decode(sample.type, received.raw.cdr, received.raw.types)
    except MessageError as error:
        return error
    return replace(received, sample=dataclasses.replace(sample, message=message))
