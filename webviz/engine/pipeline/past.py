"""Pictures of the last seconds, for browsers whose picture is older than the scene."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import fields

import numpy as np

from webviz.engine.pipeline.picking import Shot

KEPT_S = 3.0
"""Longer than a picture is under way to a browser."""
MAX_BYTES = 64_000_000
"""Of arrays; the messages that they were made of take about as much again."""
MAX_SHOTS = 200


class Past:
    """Keeps what was replaced, for some seconds.

    Args:
        clock: monotonic time in seconds.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._shots: deque[tuple[float, str, Shot, int]] = deque()
        self._bytes = 0

    def keep(self, scope: str, shot: Shot) -> None:
        """Keep what was drawn in a scope until now."""
        size = _size(shot)
        self._bytes += size
        self._shots.append((self._clock(), scope, shot, size))
        self._trim()

    def of(self, scope: str) -> Iterator[Shot]:
        """Yield the pictures of a scope, newest first."""
        self._trim()
        return (shot for _, name, shot, _ in reversed(self._shots) if name == scope)

    def _trim(self) -> None:
        oldest = self._clock() - KEPT_S
        while self._shots and (
            self._shots[0][0] < oldest or self._bytes > MAX_BYTES or len(self._shots) > MAX_SHOTS
        ):
            self._bytes -= self._shots.popleft()[3]


def _size(shot: Shot) -> int:
    nodes = (node for group in shot.groups.values() for node in group.nodes.values())
    values = (getattr(node, f.name) for node in nodes for f in fields(node))
    return sum(value.nbytes for value in values if isinstance(value, np.ndarray))
