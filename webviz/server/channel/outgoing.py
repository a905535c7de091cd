"""Queue of messages to one page over the channel."""

from __future__ import annotations

import asyncio
import itertools
from collections.abc import Callable

import msgspec

from webviz.server.channel.messages import ToPage
from webviz.server.channel.stores import Watched
from webviz.server.sending.congestion import CongestionControl

MAX_WAITING = 256
"""Messages that may wait for one page; a page that takes none of them has to connect again."""
MAX_WAITING_BYTES = 32 << 20
"""Limit in bytes of these messages together; the largest are configs to download."""


class PageQueue:
    """The messages that wait for one page.

    Args:
        key: which the page names to open the channel.
        congestion: of its link.
    """

    def __init__(self, key: str, congestion: CongestionControl) -> None:
        self.key: str | None = key
        self.congestion = congestion
        self.abort: Callable[[], None] = lambda: None
        """Ends the connection of the page, if it has one."""
        self.waiting: dict[object, bytes] = {}
        self.bulk: dict[str, bytes] = {}
        """Bytes to send once no message waits, by key."""
        self.watched = Watched()
        self.is_full = False
        """True if something did not fit any more."""
        self.filled = asyncio.Event()
        self._numbers = itertools.count()

    def put_first(self, message: ToPage) -> None:
        """Send a message before all that waits."""
        self.waiting = {type(message): msgspec.json.encode(message), **self.waiting}

    def put(self, message: ToPage, data: bytes) -> None:
        """Send a message after those that wait, in place of one of its kind if that is `kept`.

        Args:
            message: what it says.
            data: the same as JSON.
        """
        key = type(message) if message.is_latched else next(self._numbers)
        self.waiting.pop(key, None)
        size = len(data) + sum(map(len, self.waiting.values()))
        if len(self.waiting) < MAX_WAITING and size <= MAX_WAITING_BYTES and not self.is_full:
            self.waiting[key] = data
        else:
            self.waiting.clear()
            self.is_full = True
