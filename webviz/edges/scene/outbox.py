"""Orders the messages for a browser: small ones first, large ones as fast as it can take them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, Protocol, TypeVar

import numpy as np

BULK_BYTES = 1 << 15
"""Size above which a message is large: clouds, images, meshes."""

WINDOW_BYTES = 1 << 19
"""Large messages per frame. At 1 MB/s, they delay the next frame by half a second."""


class Message(Protocol):
    """The part of viser's messages that is used here."""

    def redundancy_key(self) -> str:
        """A newer message with the same key replaces this one."""
        ...


M = TypeVar("M", bound=Message)

CLOUD = "cloud"
"""Property of the messages that are parts of one thing: its name, its version, and the number of
parts in it. Pages show a version once they have all parts (`web/scene/whole.js`)."""


@dataclass(frozen=True)
class Progress:
    """How far a browser is; those with the same need the same messages next.

    Args:
        cursor: number of the last message that was sent or put in the line.
        line: keys and numbers of the messages that wait.
        begun: those that are sent even if newer ones exist, by number: the other parts of a cloud
            of which it has some.
    """

    cursor: int
    line: tuple[tuple[object, int], ...]
    begun: Mapping[int, Any] = field(compare=False)


class Outbox:
    """Chooses the messages of the next websocket frame of a browser.

    A websocket delivers in order, so a frame that takes seconds delays all later ones. Hence each
    frame has all small messages, and large ones up to a limit. Large messages update existing
    nodes, so later messages may overtake them. They wait in a line, in which a newer version takes
    the place of the older one, so that a slow browser receives all of them in turn. A cloud of
    several parts that was begun is finished first, or a slow browser would never have a whole one.

    Args:
        last: type of messages that must not overtake earlier ones.
    """

    def __init__(self, last: type) -> None:
        self._last = last
        self.cursor = -1
        """Number of the last message that was sent or put in the line."""
        self._line: dict[object, int] = {}
        self._begun: Mapping[int, Any] = MappingProxyType({})

    @property
    def progress(self) -> Progress:
        """How far the browser is."""
        return Progress(self.cursor, tuple(self._line.items()), self._begun)

    @progress.setter
    def progress(self, progress: Progress) -> None:
        self.cursor, self._line = progress.cursor, dict(progress.line)
        self._begun = progress.begun

    def is_waiting(self) -> bool:
        """Whether messages are in the line."""
        return bool(self._line)

    def small(self, live: Mapping[int, M], newest: int, limit: int | None) -> list[M]:
        """The next small messages; large ones are put in the line.

        Args:
            live: the existing messages, in order of their numbers.
            newest: number of the last message to consider.
            limit: maximum count of messages to consider, or None.
        """
        if newest - self.cursor > len(live):
            numbers = [n for n in live if self.cursor < n <= newest]
        else:
            numbers = [n for n in range(self.cursor + 1, newest + 1) if n in live]
        if limit is not None and len(numbers) > limit:
            numbers = numbers[:limit]
            newest = numbers[-1]
        self.cursor = max(self.cursor, newest)
        window = []
        for number in numbers:
            message = live[number]
            if bulk(message) > BULK_BYTES:
                key = message.redundancy_key()
                is_begun = self._line.get(key) in self._begun
                self._line[(key, "next") if is_begun else key] = number
            elif self._line and isinstance(message, self._last):
                self._line[number] = number
            else:
                window.append(message)
        return window

    def large(self, live: Mapping[int, M]) -> list[M]:
        """The next messages of the line that still exist: as many as fit, but at least one."""
        window: list[M] = []
        room = WINDOW_BYTES
        while self._line:
            key, number = next(iter(self._line.items()))
            message = live.get(number)
            if message is None:
                message = self._unfinished(key, number, live)
            if message is not None:
                room -= bulk(message)
                if window and room < 0:
                    break
                window.append(message)
            del self._line[key]
            if message is not None and number not in self._begun:
                self._begin(message, live)
        if self._begun:
            self._begun = {n: self._begun[n] for n in self._line.values() if n in self._begun}
        return window

    def _begin(self, first: Message, live: Mapping[int, M]) -> None:
        """Keep the other parts of a cloud of which one is sent."""
        cloud = _cloud(first)
        if cloud is None:
            return
        parts = {}
        for number in self._line.values():
            part = live.get(number)
            if part is not None and _cloud(part) == cloud:
                parts[number] = part
        self._begun = {**self._begun, **parts}
        self._line = {
            part.redundancy_key() if (part := parts.get(number)) else key: number
            for key, number in self._line.items()
        }

    def _unfinished(self, key: object, number: int, live: Mapping[int, M]) -> M | None:
        """A part of a cloud that was begun, unless the cloud is gone."""
        is_replaced = self._line.get((key, "next"), -1) in live
        return self._begun.get(number) if is_replaced else None


def _cloud(message: Message) -> tuple[Any, ...] | None:
    """Which version of which cloud a message is part of, None if it is whole."""
    return getattr(message, "updates", {}).get(CLOUD)


def bulk(message: Message) -> int:
    """Approximate size in bytes of the properties that a message assigns."""
    updates: dict[str, Any] = getattr(message, "updates", {})
    return sum(
        value.nbytes if isinstance(value, np.ndarray) else len(value)
        for value in updates.values()
        if isinstance(value, np.ndarray | bytes)
    )
