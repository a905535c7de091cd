"""Messages of many transforms, from which a frame takes its samples when they are read.

Of hundreds of frames that move, few are looked up at another time than the newest: to store a
message once takes a tenth of the time of storing each of its transforms.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from webviz.data.transforms.arrays import F64
from webviz.data.transforms.geometry import PACKED

I64 = NDArray[np.int64]


class Batches:
    """The recent messages of one list of frames; in each, those that follow have later stamps.

    Args:
        size: N, the transforms of a message.
        cache_time_ns: history kept of each frame.
        most: messages kept, whatever their stamps.
        changed: called when a frame begins or ends to follow.

    Attributes:
        is_followed: bool (N,): the frames that take their samples from here.
        newest_ns: int64 (N,), stamps of the newest message.
        rows: float64 (N, 7), its poses.
        count: messages so far.
    """

    def __init__(
        self, size: int, cache_time_ns: int, most: int, changed: Callable[[], None]
    ) -> None:
        self.is_followed = np.zeros(size, np.bool_)
        self.newest_ns = np.full(size, np.iinfo(np.int64).min)
        self.rows: F64 = np.empty((size, 7))
        self.count = 0
        self._cache_time_ns = cache_time_ns
        self._most = most
        self._changed = changed
        self._messages: deque[tuple[np.int64, I64, bytes]] = deque()
        """The newest stamp that was followed, all stamps, and the poses."""
        self._received = 0, 0, self.newest_ns
        """The number of the last message whose time of reception is known, that, and its stamps."""
        self._leaps: tuple[int, Sequence[bool]] = -1, ()

    def follow(self, place: int, newest_ns: int) -> None:
        """Let a frame follow, whose newest stamp is known."""
        self.is_followed[place] = True
        self.newest_ns = self.newest_ns.copy()  # messages share it
        self.newest_ns[place] = newest_ns
        self._changed()

    def leave(self, place: int) -> None:
        """Let a frame go its own way."""
        self.is_followed[place] = False
        self._changed()

    def fitting(self, stamps_ns: I64, rows: F64) -> NDArray[np.bool_]:
        """Return which transforms could be added: finite, later than before, with the others.

        Far from the others, one could keep messages for longer than the cache time.
        """
        if not self.is_followed.any():
            return self.is_followed
        horizon_ns = stamps_ns[self.is_followed].max() - self._cache_time_ns
        is_later = (stamps_ns > self.newest_ns) & (stamps_ns >= horizon_ns)
        return is_later & np.isfinite(rows.sum(axis=1))

    def add(self, stamps_ns: I64, rows: F64, received_ns: int) -> None:
        """Add a message; the transforms of all frames that follow are `fitting`.

        Args:
            stamps_ns: int64 (N,).
            rows: float64 (N, 7), translations in metres and canonical rotations (x, y, z, w).
            received_ns: time of reception; 0 if unknown.
        """
        messages = self._messages
        # Frames prune what is older than this when they take the newest sample.
        horizon_ns = self.newest_ns[self.is_followed].min() - self._cache_time_ns
        while messages and (messages[0][0] < horizon_ns or len(messages) >= self._most):
            messages.popleft()
        messages.append((stamps_ns[self.is_followed].max(), stamps_ns, rows.tobytes()))
        self.newest_ns, self.rows = stamps_ns, rows
        self.count += 1
        if received_ns:
            self._received = self.count, received_ns, stamps_ns

    def since(self, count: int, place: int) -> list[tuple[int, bytes]]:
        """Return the samples of a frame after the first `count` messages: stamps, and `PACKED`."""
        start = place * PACKED.size
        missed = min(self.count - count, len(self._messages))
        messages = (self._messages[-number] for number in range(missed, 0, -1))
        return [(int(ns[place]), poses[start : start + PACKED.size]) for _, ns, poses in messages]

    def delay_ns(self, count: int, place: int) -> int | None:
        """Return the time from the stamp of a frame to its reception; None if it is unknown.

        Args:
            count: the message must have come after the first `count`.
            place: of the frame.
        """
        number, received_ns, stamps_ns = self._received
        return received_ns - int(stamps_ns[place]) if number > count else None

    def leaps(self, ratio: float, least_m: float) -> Sequence[bool]:
        """Return for each frame whether its last step is one of two back to where it was before.

        Args:
            ratio: least one between the step and the distance of both steps together.
            least_m: smaller steps do not count, in metres.

        Returns:
            As far as three messages tell; until then each may be.
        """
        if self._leaps[0] != self.count:
            is_leap = np.ones(len(self.rows), np.bool_)
            if len(self._messages) >= 3:
                last, other, before = (
                    np.frombuffer(self._messages[-number][2]).reshape(-1, 7)[:, :3]
                    for number in (1, 2, 3)
                )
                with np.errstate(all="ignore"):
                    step, both = (np.linalg.norm(last - each, axis=1) for each in (other, before))
                    is_leap = step > np.maximum(ratio * both, least_m)
            self._leaps = self.count, is_leap.tolist()
        return self._leaps[1]
