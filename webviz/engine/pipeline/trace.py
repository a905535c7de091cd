"""Latency traces: the times of one sample on its way to the browsers."""

from __future__ import annotations

import contextlib
import time
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future

import msgspec

from webviz.api.errors import Error
from webviz.api.sample import Sample
from webviz.sources import Raw

MAX_ASKED = 100
_UNTIMED = contextlib.nullcontext()


class Trace(msgspec.Struct, frozen=True):
    """The times of one sample on its way to the browsers, in nanoseconds of ROS time.

    From its arrival on they advance with the wall clock, so that a paused or slow simulation hides
    no delay.

    Args:
        input: of the display.
        number: of the sample, from 0.
        published_ns: its stamp, 0 if it has none.
        received_ns: its arrival.
        ready_ns: its transform was available, and its partners if the input is synchronized.
        decoded_ns: it was decoded.
        drawn_ns: the display had drawn it.
        sent_ns: it was passed to the connections.
        acknowledged_ns: all browsers that have loaded had applied it; None if one did not answer,
            or none has loaded.
    """

    input: str
    number: int
    published_ns: int
    received_ns: int
    ready_ns: int
    decoded_ns: int
    drawn_ns: int
    sent_ns: int
    acknowledged_ns: int | None = None

    def times(self) -> dict[str, int]:
        """Return the known times by name, in order."""
        names = ("published", "received", "ready", "decoded", "drawn", "sent", "acknowledged")
        return {name: ns for name in names if (ns := getattr(self, f"{name}_ns"))}

    def __str__(self) -> str:
        times = self.times()
        first = next(iter(times.values()))
        return ", ".join(f"{name} {(ns - first) / 1e6:+.1f} ms" for name, ns in times.items())


class _Begun(msgspec.Struct):
    """A sample on its way; times are monotonic, in seconds."""

    sample: Sample
    arrived_s: float
    ready_s: float
    decoded_s: float
    drawn_s: float = 0.0

    def trace(self, sent_s: float) -> Trace:
        sample = self.sample

        def ros_ns(at_s: float) -> int:
            return sample.received_ns + round((at_s - self.arrived_s) * 1e9)

        steps = (self.ready_s, self.decoded_s, self.drawn_s, sent_s)
        return Trace(
            sample.input, sample.number, sample.stamp_ns, sample.received_ns, *map(ros_ns, steps)
        )


class Tracer:
    """Traces the next sample of displays on request.

    Args:
        clock: monotonic time in seconds, the one of `Raw.arrived_s`.
    """

    def __init__(self, clock: Callable[[], float]) -> None:
        self.clock = clock
        self._requests: dict[str, list[Future[Trace]]] = {}
        self._begun: dict[str, _Begun] = {}
        self.on_sent: Callable[[Mapping[str, Trace], float], object] = lambda traces, at_s: None
        """Called with the samples that were sent, by display, and when that was."""
        self._timing: set[str] = set()
        self.busy_s: defaultdict[str, float] = defaultdict(float)
        """Seconds of a processor that reading and drawing took in the frame loop, by display."""

    def timed(self, display: str) -> contextlib.AbstractContextManager[None]:
        """Count the time of the block for a display."""
        return self._timed(display) if self._timing else _UNTIMED

    def time(self, purpose: str, is_wanted: bool) -> None:
        """Count the time that displays take for a purpose from now on, or no longer."""
        (self._timing.add if is_wanted else self._timing.discard)(purpose)

    @contextlib.contextmanager
    def _timed(self, display: str) -> Iterator[None]:
        began = time.thread_time()
        try:
            yield
        finally:
            self.busy_s[display] += time.thread_time() - began

    def ask(self, display: str, answer: Future[Trace]) -> None:
        """Trace the next sample of a display. Cancel the answer to stop waiting.

        Raises:
            Error: too many traces are requested.
        """
        for traced, answers in list(self._requests.items()):
            self._requests[traced] = [each for each in answers if not each.cancelled()]
            if not self._requests[traced]:
                del self._requests[traced]
        if sum(map(len, self._requests.values())) >= MAX_ASKED:
            raise Error("Too many traces at once. Try again later.")
        if display not in self._requests:
            self.forget(display)  # left from a cancelled request
        self._requests.setdefault(display, []).append(answer)

    def wants(self, display: str) -> bool:
        """Return whether the next sample of a display is to be traced."""
        return display in self._requests

    def decoded(self, display: str, sample: Sample, raw: Raw, ready_s: float, at_s: float) -> None:
        """Note that a display holds a sample, decoded at `at_s`."""
        self._begun[display] = _Begun(sample, raw.arrived_s, ready_s, at_s)

    def drawn(self, display: str) -> None:
        """Note that a display has drawn its samples."""
        if begun := self._begun.get(display):
            begun.drawn_s = self.clock()

    def sent(self) -> None:
        """Everything drawn was sent: answer."""
        displays = [display for display, begun in self._begun.items() if begun.drawn_s]
        if not displays:
            return
        now = self.clock()
        traces = {display: self._begun.pop(display).trace(now) for display in displays}
        self.on_sent(traces, now)
        for display, trace in traces.items():
            for answer in self._requests.pop(display, ()):
                if answer.set_running_or_notify_cancel():
                    answer.set_result(trace)

    def forget(self, display: str) -> None:
        """Discard a sample that will not be drawn."""
        self._begun.pop(display, None)
