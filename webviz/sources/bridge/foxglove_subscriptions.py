"""The subscriptions at a Foxglove server, open ones and those that have just ended."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator

import msgspec

MAX_ENDED = 100
"""Ended subscriptions whose messages are still taken."""


class ChannelSubscription(msgspec.Struct, frozen=True):
    """A subscription.

    Args:
        id: chosen by webviz.
        topic: of the channel.
        channel: its id.
        asked: of the wish, see `webviz.sources.Subscription`.
    """

    id: int
    topic: str
    channel: int
    asked: int


class ChannelSubscriptions:
    """Subscriptions by topic and by id.

    Messages that are on their way when a subscription ends belong to its topic still, unless that
    has another channel by then, and so perhaps another type.
    """

    def __init__(self) -> None:
        self._open: dict[str, ChannelSubscription] = {}
        self._by_id: dict[int, ChannelSubscription] = {}
        self._ended: deque[ChannelSubscription] = deque()

    def __contains__(self, topic: str) -> bool:
        return topic in self._open

    def __iter__(self) -> Iterator[ChannelSubscription]:
        """Iterate over those that are open."""
        return iter(list(self._open.values()))

    def channel(self, topic: str) -> int | None:
        """Return the channel that a topic is subscribed to."""
        line = self._open.get(topic)
        return line.channel if line else None

    def topic(self, id: int) -> str:
        """Return the topic of messages of a subscription, "" if it is unknown."""
        line = self._by_id.get(id)
        return line.topic if line else ""

    def begin(self, line: ChannelSubscription) -> None:
        """Add one."""
        for ended in self._ended:
            if ended.topic == line.topic and ended.channel != line.channel:
                self._by_id.pop(ended.id, None)
        self._open[line.topic] = self._by_id[line.id] = line

    def end(self, line: ChannelSubscription) -> None:
        """End one."""
        del self._open[line.topic]
        self._ended.append(line)
        if len(self._ended) > MAX_ENDED:
            self._by_id.pop(self._ended.popleft().id, None)
