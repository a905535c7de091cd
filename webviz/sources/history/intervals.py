"""Spans of time in which frames have transforms: those that ended are needed long after."""

from __future__ import annotations

import bisect
from collections.abc import Iterator, Mapping, Sequence

from webviz.data.messages import MessageError, TFMessage, decode
from webviz.data.recordings.latched import TF

GAP_NS = 1_000_000_000
"""Time in ns without a transform after which those of a frame count as ended."""
MAX_ENDS = 200
"""Newest ends that a seek reads."""


def links_in(cdr: bytes) -> Iterator[tuple[str, str]]:
    """Yield parents and children of the transforms of a message; none if it cannot be decoded."""
    try:
        message: TFMessage = decode(TF, cdr)
    except MessageError:
        return
    for each in message.transforms:
        yield each.parent.removeprefix("/"), each.child.removeprefix("/")


class ValidityIntervals:
    """The spans of time in which each frame has transforms."""

    def __init__(self) -> None:
        self._begins: dict[str, list[int]] = {}
        self._ends: dict[str, list[int]] = {}
        self._parents: dict[str, str] = {}
        """The last ones, of static transforms, too."""

    def add(self, parent: str, child: str, stamp_ns: int) -> None:
        """Note a transform; stamps must not decrease."""
        self._parents[child] = parent
        ends = self._ends.setdefault(child, [])
        begins = self._begins.setdefault(child, [])
        if ends and stamp_ns - ends[-1] <= GAP_NS:
            ends[-1] = stamp_ns
        else:
            begins.append(stamp_ns)
            ends.append(stamp_ns)

    def read(self, cdr: bytes, stamp_ns: int, is_static: bool = False) -> None:
        """Note the transforms of a message; stamps must not decrease."""
        for parent, child in links_in(cdr):
            if is_static:
                self._parents[child] = parent
            else:
                self.add(parent, child, stamp_ns)

    def above(self, frame: str, at_ns: int) -> Mapping[str, int | None]:
        """Return the moving frames from one up to its root, and when their last transforms were.

        Args:
            frame: frame id.
            at_ns: of the transforms until then; None stands for less than `GAP_NS` before.
        """
        ends: dict[str, int | None] = {}
        visited = set[str]()
        while frame in self._parents and frame not in visited:
            visited.add(frame)
            number = bisect.bisect_right(self._begins.get(frame, ()), at_ns) - 1
            if number >= 0:
                end_ns = self._ends[frame][number]
                ends[frame] = end_ns if end_ns < at_ns else None
            frame = self._parents[frame]
        return ends

    def ended_ns(self, before_ns: int) -> Sequence[int]:
        """Return when all frames without a transform at a time had their last, in order."""
        ends = set[int]()
        for child, begins in self._begins.items():
            number = bisect.bisect_right(begins, before_ns) - 1
            if number >= 0 and (end_ns := self._ends[child][number]) < before_ns:
                ends.add(end_ns)
        return sorted(ends)[-MAX_ENDS:]
