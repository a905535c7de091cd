"""The last messages of topics that a page inspects."""

from __future__ import annotations

import time
from collections.abc import Mapping, Set
from typing import Any

from webviz.api.declared import Topic
from webviz.data.messages import MessageError, decode, to_tree
from webviz.data.messages.tree import Tree
from webviz.engine.feature import Feature, command, store
from webviz.engine.parts.part import Batches, PartContext
from webviz.engine.parts.topics import type_of
from webviz.engine.state import Inspected
from webviz.engine.store import PageStore
from webviz.sources import Raw, Subscriber, Subscription

EVERY_S = 1.0
"""Interval between readings of an inspected message."""
MAX_INSPECTED = 64
"""Topics that are looked into at once."""


class MessageStore(PageStore, frozen=True):
    """The last message on a topic, see `Inspected`."""

    message: Tree | None
    problem: str
    size: int
    received: float


class TopicsFeature(Feature):
    """Subscribes to the topics that pages and programs look into."""

    name = "Inspected topics"
    module = "topics.js"

    def __init__(self, context: PartContext) -> None:
        super().__init__(context)
        self._subscriber = Subscriber()
        self._own = ""
        self._of_pages: frozenset[str] = frozenset()
        self._last: dict[str, tuple[Raw, float]] = {}
        self._read: dict[str, tuple[float, Raw, Inspected]] = {}

    def watched(self, stores: Set[str]) -> None:
        """Look into the topics whose messages pages show."""
        self.inspect_topics(frozenset(store.partition(":")[2] for store in stores))

    def subscriptions(self) -> Mapping[str, Subscription]:
        """Return the topics that are inspected while a browser is open, with their first types."""
        inspected = self._inspected() if self.context.is_watched() else ()
        offers = {topic: self.context.offers.get(topic) for topic in inspected}
        return self._subscriber.subscribe(
            {
                topic: Subscription(offer.publishers[0].type, Topic(topic))
                for topic, offer in offers.items()
                if offer and offer.publishers
            }
        )

    def take(self, batches: Batches) -> None:
        """Keep the newest messages of the topics that are looked into."""
        for topic in self._inspected() & batches.keys():
            if (newest := next(reversed(list(batches[topic])), None)) is not None:
                self._last[topic] = newest, time.time()

    def update(self) -> None:
        """Forget topics that no page shows."""
        for topic in self._last.keys() - self._inspected():
            del self._last[topic]
            self._read.pop(topic, None)

    def is_attended(self) -> bool:
        """Return whether a page inspects a topic."""
        return bool(self._inspected())

    def state(self) -> Mapping[str, Any]:
        """Return the inspected topics."""
        return {"inspected": {topic: self._look(topic) for topic in self._inspected()}}

    def inspection(self, topic: str) -> Inspected | None:
        """Return the report on a topic, None if it is not inspected."""
        return self._look(topic) if topic in self._inspected() else None

    @store()
    def message(self, topic: str) -> MessageStore | None:
        """Return the last message on a topic; None if it is not inspected."""
        inspected = self.inspection(topic)
        if inspected is None:
            return None
        return MessageStore(
            message=inspected.message,
            problem=inspected.problem,
            size=inspected.size,
            received=round(inspected.received_s, 1),
        )

    @command(None)
    def inspect_topic(self, topic: str) -> None:
        """Follow a topic that need not be shown: its rate and its last message; "" is none.

        Programs and plug-ins follow one at a time, besides those that pages follow.
        """
        self._own = topic

    @command(None)
    def inspect_topics(self, topics: frozenset[str]) -> None:
        """Follow exactly these topics for all pages; the viewer itself keeps count of who looks."""
        self._of_pages = frozenset(sorted(topics)[:MAX_INSPECTED])

    def _inspected(self) -> set[str]:
        return {topic for topic in (self._own, *self._of_pages) if topic}

    def _look(self, topic: str) -> Inspected:
        """Return the report on an inspected topic."""
        offer = self.context.offers.get(topic)
        type_ = type_of(offer) if offer else ""
        if not offer or not offer.publishers:
            return Inspected(problem="No publisher on this topic.")
        if offer.problem:
            return Inspected(type_, problem=f"This topic cannot be read: {offer.problem}.")
        if topic not in self._last:
            return Inspected(type_, problem="No message has arrived yet.")
        raw, received_s = self._last[topic]
        now = self.context.clock()
        read = self._read.get(topic)
        if read is None or (read[1] is not raw and not 0.0 <= now - read[0] < EVERY_S):
            read = now, raw, _read(type_, raw, received_s)
            self._read[topic] = read
        return read[2]


def _read(type_name: str, raw: Raw, received_s: float) -> Inspected:
    size = len(raw.cdr)
    try:
        tree = to_tree(decode(type_name, raw.cdr, raw.types))
    except MessageError as error:
        problem = f"The last message cannot be read: {error}"
        return Inspected(type_name, None, problem, size, received_s)
    return Inspected(type_name, tree, "", size, received_s)
