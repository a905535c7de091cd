"""Fast reading of /tf messages with the frames of an earlier one: only stamps and numbers."""

from __future__ import annotations

import sys
from collections.abc import Sequence

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz.data.messages import TFMessage

MIN_TRANSFORMS = 16
"""Number of transforms in a message from which on it is decoded as a whole; smaller ones are
decoded faster one by one."""
MAX_SIZES = 64
SAME_SIZE = 4
"""Layouts per message size, such as of robots of a fleet. Other messages are decoded."""

_NATIVE = b"\0\1" if sys.byteorder == "little" else b"\0\0"


class TransformBatch(msgspec.Struct, frozen=True):
    """The transforms of a message.

    Args:
        names: N times a parent and its child.
        stamps_ns: N stamps.
        poses: float64 (N, 7): translations in metres and rotations (x, y, z, w), as sent.
    """

    names: Sequence[tuple[str, str]]
    stamps_ns: Sequence[int]
    poses: NDArray[np.float64]


class TransformLayout:
    """The byte layout of messages with certain frames.

    Args:
        cdr: a message.
        message: the same, decoded.
    """

    def __init__(self, cdr: bytes, message: TFMessage) -> None:
        self._names = [(t.parent, t.child) for t in message.transforms]
        self.children = frozenset(child for _, child in self._names)
        """Children of all transforms."""
        stamps, numbers, pos = [], [], 8  # after the encapsulation and the count
        for parent, child in self._names:
            stamps.append(pos)
            pos = _behind(pos + 8, parent)
            pos = _behind(pos, child)
            pos += (4 - pos) & 7
            numbers.append(pos)
            pos += 56
        self._size = pos
        self._stamps = (np.array(stamps)[:, None] - 4) // 4 + np.arange(2)
        self._numbers = (np.array(numbers)[:, None] - 4) // 4 + np.arange(14)
        is_fixed = np.ones(pos // 4 - 1, np.bool_)
        is_fixed[self._stamps] = is_fixed[self._numbers] = False
        self._fixed = np.flatnonzero(is_fixed)
        self._expected = _words(cdr)[self._fixed] if len(cdr) == pos else None
        self._head = cdr[:4]

    def fits(self, cdr: bytes) -> bool:
        """Return whether another message has the same frames."""
        if len(cdr) != self._size or cdr[:4] != self._head or self._expected is None:
            return False
        return np.array_equal(_words(cdr)[self._fixed], self._expected)

    def read(self, cdr: bytes) -> TransformBatch:
        """Return the transforms of a message that it `fits`."""
        words = _words(cdr)
        seconds, nanoseconds = words[self._stamps].T
        stamps = seconds.view(np.int32) * np.int64(1_000_000_000) + nanoseconds
        poses = words[self._numbers].view(np.float64)
        return TransformBatch(self._names, stamps.tolist(), poses)


class Layouts:
    """The layouts of recurring messages."""

    def __init__(self) -> None:
        self._by_size: dict[int, list[TransformLayout]] = {}

    def of(self, cdr: bytes) -> TransformLayout | None:
        """Return the layout of a message, None if it is unknown."""
        for layout in self._by_size.get(len(cdr), ()):
            if layout.fits(cdr):
                return layout
        return None

    def learn(self, cdr: bytes, message: TFMessage) -> None:
        """Remember the layout of a message, if that saves time."""
        if len(message.transforms) < MIN_TRANSFORMS or cdr[:2] != _NATIVE:
            return
        if len(self._by_size) >= MAX_SIZES and len(cdr) not in self._by_size:
            self._by_size.clear()
        layouts = self._by_size.setdefault(len(cdr), [])
        if len(layouts) < SAME_SIZE:
            layouts.append(TransformLayout(cdr, message))


def _behind(pos: int, text: str) -> int:
    """Return the position of the word after a string at a position."""
    return (pos + 4 + len(text.encode()) + 1 + 3) & ~3


def _words(cdr: bytes) -> NDArray[np.uint32]:
    return np.frombuffer(cdr, np.uint32, offset=4)
