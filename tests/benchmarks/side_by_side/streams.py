"""Published streams: serialised messages with gaps for the stamp and for the mark."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from side_by_side import strip
from side_by_side.marks import Lane
from webviz.data.messages import encode

STAMP = struct.Struct("<iI")
# Values that no message has otherwise, found in its bytes to know where to write.
NO_STAMP = (0x5EC0_5EC1, 0x0ABC_DEF1)
NO_MARK = 3.25e33


@dataclass
class Stream:
    """Publications on one topic.

    Args:
        topic: its name.
        type: of its messages.
        hz: publications per second; 0 is one, latched.
        variants: the messages as nested mappings, published in turn, so that everything moves.
        lane: how publications are recognised; None leaves them unmarked.
        prefill: publications made as fast as they are taken, before anything is measured.
    """

    topic: str
    type: str
    hz: float
    variants: Sequence[dict[str, Any]] = field(repr=False)
    lane: Lane | None = None
    prefill: int = 0

    @property
    def is_latched(self) -> bool:
        """Return whether it is sent once, to each subscriber."""
        return self.hz == 0

    @cached_property
    def templates(self) -> list[Template]:
        """The messages, serialised."""
        return [Template(encode(self.type, values)) for values in self.variants]

    @cached_property
    def stamp_at(self) -> int | None:
        """Return where the first stamp lies in the bytes of a message, None if it has none."""
        stamps = self.templates[0].stamps
        return int(stamps[0, 0]) if len(stamps) else None

    def publication(self, number: int, stamp_ns: int) -> bytes:
        """The bytes of a publication."""
        template = self.templates[number % len(self.templates)]
        return template.filled(stamp_ns, self.lane, number)


class Template:
    """One message with gaps."""

    def __init__(self, cdr: bytes) -> None:
        self._bytes = np.frombuffer(bytearray(cdr), np.uint8)
        self.stamps = _places(cdr, STAMP.pack(*NO_STAMP))
        self._marks = [
            (at, dtype)
            for dtype in ("<f4", "<f8")
            for at in _places(cdr, np.array(NO_MARK, dtype).tobytes())
        ]
        gap = bytes([strip.GAP]) * strip.LENGTH * strip.BLOCK
        strips = _places(cdr, gap)
        self._strip = strips if len(strips) == strip.BLOCK else None

    def filled(self, stamp_ns: int, lane: Lane | None, number: int) -> bytes:
        """The message of a publication."""
        stamp = STAMP.pack(*divmod(stamp_ns, 1_000_000_000))
        self._bytes[self.stamps] = np.frombuffer(stamp, np.uint8)
        if lane is not None:
            for at, dtype in self._marks:
                self._bytes[at] = np.array(lane.encode(number), dtype).reshape(1).view(np.uint8)
            if self._strip is not None:
                self._bytes[self._strip] = strip.cells(lane.number, number).view(np.uint8)
        return self._bytes.tobytes()


def _places(data: bytes, what: bytes) -> NDArray[np.intp]:
    """The index of every byte of every occurrence: (occurrences, length)."""
    starts, at = [], data.find(what)
    while at >= 0:
        starts.append(at)
        at = data.find(what, at + len(what))
    return np.array(starts, np.intp).reshape(-1, 1) + np.arange(len(what))


def header(frame: str) -> dict[str, Any]:
    """A header whose stamp is filled in."""
    sec, nanosec = NO_STAMP
    return {"frame_id": frame, "stamp": {"sec": sec, "nanosec": nanosec}}
