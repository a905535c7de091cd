"""What one browser still has to be sent: small messages at once, large ones as it can take them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol, TypeVar

import numpy as np

BULK_BYTES = 1 << 15
"""What carries more waits for its turn: clouds, pictures, meshes."""

WINDOW_BYTES = 1 << 19
"""Of large messages in one piece. At 1 MB/s, what comes next is half a second behind."""


class Message(Protocol):
    """What matters of viser's messages."""

    def redundancy_key(self) -> str:
        """What a newer message must have in common to replace it."""
        ...


M = TypeVar("M", bound=Message)


class Outbox:
    """Decides what goes into the next websocket frame of one browser.

    A websocket delivers in order, so a frame that takes seconds holds up all that follows. Hence
    each frame has every small message, and large ones up to a limit. Large ones update nodes that
    are there already, so they may come later than what was queued after them. They take turns: a
    newer version of one takes the place of the older in the line, and a slow browser sees all of
    them change, none in vain.

    Args:
        last: the type of messages that must not arrive before what was queued before them.
    """

    def __init__(self, last: type) -> None:
        self._last = last
        self.cursor = -1
        """Number of the last message that was sent or is in the line."""
        self._line: dict[object, int] = {}

    def is_waiting(self) -> bool:
        """Whether large messages are in the line."""
        return bool(self._line)

    def small(self, live: Mapping[int, M], newest: int, limit: int | None) -> list[M]:
        """The small messages up to number `newest`, of at most `limit` numbers; others line up.

        Args:
            live: the messages that exist, in order of their numbers.
            newest: number of the last message to consider.
            limit: None for none.
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
                self._line[message.redundancy_key()] = number
            elif self._line and isinstance(message, self._last):
                self._line[number] = number
            else:
                window.append(message)
        return window

    def large(self, live: Mapping[int, M]) -> list[M]:
        """The next messages of the line that still exist: as many as fit, at least one."""
        window: list[M] = []
        room = WINDOW_BYTES
        for key, number in tuple(self._line.items()):
            message = live.get(number)
            if message is not None:
                room -= bulk(message)
                if window and room < 0:
                    break
                window.append(message)
            del self._line[key]
        return window


def bulk(message: Message) -> int:
    """Bytes that a message would assign to the properties of a node, roughly."""
    updates: dict[str, Any] = getattr(message, "updates", {})
    return sum(
        value.nbytes if isinstance(value, np.ndarray) else len(value)
        for value in updates.values()
        if isinstance(value, np.ndarray | bytes)
    )
