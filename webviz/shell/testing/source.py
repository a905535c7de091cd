"""A source without ROS, for tests that set its messages, publishers and time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from webviz.api.bridge import Bridge
from webviz.sources import Graph, Inbox, Offer, Publisher, Raw, ReadOnly, Subscription

SECOND = 1_000_000_000
LIMIT = 1000
"""Messages per topic between two turns."""


@dataclass
class HandFedSource:
    """A source that a test feeds."""

    inbox: Inbox = field(default_factory=Inbox)
    graph: Graph = field(default_factory=lambda: ReadOnly("This source can only be read."))
    subscriptions: Mapping[str, Subscription] = field(default_factory=dict)
    topics: dict[str, Offer] = field(default_factory=dict)
    now: int = 100 * SECOND
    """ROS time in ns."""
    bridges: Sequence[Bridge] = ()
    """Connections to bridges."""
    clock_count: int | None = None
    """Number of messages on /clock; None is wall time."""
    _snapshot: dict[str, Offer] = field(default_factory=dict)

    def put(self, topic: str, type_name: str, cdr: bytes) -> None:
        """Receive a message now, from a reliable publisher."""
        if topic not in self.topics:
            publisher = Publisher("/test", type_name, "reliable", "volatile")
            self.topics[topic] = Offer((publisher,), ("reliable", "volatile"))
        self.inbox.put(topic, Raw(cdr, self.now))

    def want(self, subscriptions: Mapping[str, Subscription]) -> None:
        """Replace all subscriptions."""
        for topic in self.subscriptions.keys() - subscriptions.keys():
            self.inbox.close(topic)
        for topic in subscriptions.keys() - self.subscriptions.keys():
            self.inbox.open(topic, LIMIT)
        self.subscriptions = dict(subscriptions)

    def offers(self) -> Mapping[str, Offer]:
        """All topics; the same mapping until something changes."""
        if self._snapshot != self.topics:
            self._snapshot = dict(self.topics)
        return self._snapshot

    def now_ns(self) -> int:
        """ROS time."""
        return self.now

    def clock_messages(self) -> int | None:
        """Return the number of /clock messages, which is `clock_count`."""
        return self.clock_count

    def resolve(self, topic: str) -> str:
        """Return the full name of a topic."""
        if " " in topic:
            raise ValueError(f"{topic!r} is not a valid topic name: it has a space")
        return f"/{topic.removeprefix('/')}"

    def close(self) -> None:
        """Do nothing."""
