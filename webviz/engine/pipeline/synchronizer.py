"""Synchronization of messages of several inputs by stamp, as by message_filters."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Generic, TypeVar

import msgspec

P = TypeVar("P")

MAX_BYTES = 64 << 20
"""Limit in bytes of the messages of an input that wait; the newest waits, however large."""


class Gap(msgspec.Struct, frozen=True):
    """Reason why the newest message of one input is in no set.

    Args:
        present: input that has the message.
        stamp_ns: of that message.
        missing: input without a matching message.
        off_ns: by how much the nearest message of `missing` is later, negative if it is earlier;
            None if none has arrived.
    """

    present: str
    stamp_ns: int
    missing: str
    off_ns: int | None


class Synchronizer(Generic[P]):
    """Forms sets of one message per input whose stamps differ by at most the slop.

    A message completes the set whose other messages are nearest to it, the earlier one if several
    are equally near. A set removes its messages and all with earlier stamps. Queues are bounded and
    drop the message that arrived first, so stamps may start over.

    Args:
        inputs: names, at least two.
        slop_ns: 0 requires equal stamps.
        queue_size: waiting messages per input.
        size_of: bytes of a message.
    """

    def __init__(
        self,
        inputs: Sequence[str],
        slop_ns: int = 0,
        queue_size: int = 10,
        size_of: Callable[[P], int] = lambda _: 0,
    ) -> None:
        self.inputs = tuple(inputs)
        self.sets = 0
        """Number of sets formed."""
        self.dropped = 0
        """Number of messages that were in no set."""
        self._slop_ns = slop_ns
        self._queue_size = queue_size
        self._size_of = size_of
        self._queues: dict[str, dict[int, P]] = {name: {} for name in self.inputs}
        self._last: dict[str, int] = {}

    @property
    def is_waiting(self) -> bool:
        """Return whether any message waits for its partners."""
        return any(self._queues.values())

    def add(self, name: str, stamp_ns: int, payload: P) -> dict[str, P] | None:
        """Add a message; the set that it completes, by input in their order."""
        queue = self._queues[name]
        self.dropped += queue.pop(stamp_ns, None) is not None
        queue[stamp_ns] = payload
        stamps = self._nearest(name, stamp_ns)
        if stamps is None:
            size = sum(map(self._size_of, queue.values()))
            while len(queue) > self._queue_size or (len(queue) > 1 and size > MAX_BYTES):
                size -= self._size_of(queue.pop(next(iter(queue))))
                self.dropped += 1
            return None
        self._last = stamps
        self.sets += 1
        return {each: self._take(self._queues[each], stamp) for each, stamp in stamps.items()}

    def gap(self) -> Gap | None:
        """Return why the newest waiting message is in no set; None if nothing waits."""
        waiting = {name: max(queue) for name, queue in self._queues.items() if queue}
        if not waiting:
            return None
        present = max(waiting, key=lambda name: waiting[name])
        stamp_ns = waiting[present]
        offs: dict[str, int | None] = {}
        for name in self.inputs:
            stamps = [*self._queues[name], *([self._last[name]] if name in self._last else [])]
            if name != present:
                offs[name] = min((s - stamp_ns for s in stamps), key=abs, default=None)
        missing = max(offs, key=lambda name: _distance(offs[name]))
        return Gap(present, stamp_ns, missing, offs[missing])

    def _nearest(self, name: str, stamp_ns: int) -> dict[str, int] | None:
        """Return the stamps of the set that a message completes.

        Every set lies in a window of the slop that starts at its earliest stamp. Within a window
        each input is chosen independently, so trying all windows is cheap, unlike trying all
        combinations.
        """
        best: tuple[int, tuple[int, ...]] | None = None
        begins = {s for queue in self._queues.values() for s in queue}
        for begin in begins if self._slop_ns else {stamp_ns}:
            if not begin <= stamp_ns <= begin + self._slop_ns:
                continue
            picked = [
                stamp_ns if each == name else self._pick(queue, begin, stamp_ns)
                for each, queue in self._queues.items()
            ]
            stamps = tuple(stamp for stamp in picked if stamp is not None)
            if len(stamps) == len(picked):
                candidate = (sum(abs(stamp - stamp_ns) for stamp in stamps), stamps)
                best = candidate if best is None else min(best, candidate)
        return dict(zip(self.inputs, best[1], strict=True)) if best else None

    def _pick(self, queue: Mapping[int, P], begin: int, stamp_ns: int) -> int | None:
        inside = (s for s in queue if begin <= s <= begin + self._slop_ns)
        return min(inside, key=lambda s: (abs(s - stamp_ns), s), default=None)

    def _take(self, queue: dict[int, P], stamp_ns: int) -> P:
        """Remove and return a message; older ones can no longer be in a set."""
        payload = queue.pop(stamp_ns)
        for older in [s for s in queue if s < stamp_ns]:
            del queue[older]
            self.dropped += 1
        return payload


def _distance(off_ns: int | None) -> float:
    return float("inf") if off_ns is None else abs(off_ns)
