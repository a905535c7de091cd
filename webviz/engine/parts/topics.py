"""Topics: types, publishers, rates, and the last message of the inspected one."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from typing import Any

from webviz.api.declared import Topic
from webviz.data.messages import MessageError, decode, to_text
from webviz.engine.commands import Command, InspectTopic, Sender
from webviz.engine.parts.part import Batches, Core, Handler, Part
from webviz.engine.sources import Raw, Subscription
from webviz.engine.state import Inspected, Traffic

SPAN_S = 3.0
"""The window that rates are averaged over."""
MAX_LINES = 60


class TopicsPart(Part):
    """Lists topics and their traffic, and inspects one of them."""

    name = "Topics"

    def __init__(self, core: Core) -> None:
        super().__init__(core)
        self._inspected = ""
        self._counts: deque[tuple[float, dict[str, tuple[int, int]]]] = deque()
        self._last: tuple[str, Raw, float] | None = None
        self._text: tuple[Raw, str] | None = None

    @property
    def handles(self) -> Mapping[type[Command], Handler]:
        """The handler of each command."""
        return {InspectTopic: self._inspect}

    def subscriptions(self) -> Mapping[str, Subscription]:
        """The inspected topic with its first type, while a browser is connected."""
        topic = self._inspected
        offer = self.core.offers.get(topic)
        if not offer or not offer.publishers or not self.core.is_watched():
            return {}
        return {topic: Subscription(offer.publishers[0].type, Topic(topic))}

    def take(self, batches: Batches) -> None:
        """Keep the newest message of the inspected topic."""
        for raw in batches.get(self._inspected, ()):
            self._last = self._inspected, raw, self.core.clock()

    def state(self) -> Mapping[str, Any]:
        """All topics."""
        offers = self.core.offers
        types = {
            topic: tuple(sorted({publisher.type for publisher in offer.publishers}))
            for topic, offer in offers.items()
        }
        traffic, inspected = self._traffic(), self._inspected_topic()
        return {"topics": types, "offers": offers, "traffic": traffic, "inspected": inspected}

    def _inspect(self, command: InspectTopic, sender: Sender) -> None:
        self._inspected = command.topic

    def _traffic(self) -> dict[str, Traffic]:
        """Rates by topic over the last `SPAN_S`, if called a few times a second."""
        now, counts = self.core.clock(), self.core.source.inbox.received()
        self._counts.append((now, counts))
        while len(self._counts) > 2 and now - self._counts[1][0] >= SPAN_S:
            self._counts.popleft()
        then, before = self._counts[0]
        if now == then:
            return {}
        traffic = {}
        for topic, (count, size) in counts.items():
            old_count, old_size = before.get(topic, (0, 0))
            if count < old_count:  # subscribed again
                old_count = old_size = 0
            span = now - then
            traffic[topic] = Traffic((count - old_count) / span, (size - old_size) / span)
        return traffic

    def _inspected_topic(self) -> Inspected | None:
        """The inspected topic with its last message as text."""
        topic = self._inspected
        if not topic:
            return None
        offer = self.core.offers.get(topic)
        if not offer or not offer.publishers:
            return Inspected(topic, "No publisher on this topic.")
        if offer.problem:
            return Inspected(topic, f"This topic cannot be read: {offer.problem}.")
        if self._last is None or self._last[0] != topic:
            return Inspected(topic, "No message yet.")
        _, raw, at = self._last
        if self._text is None or self._text[0] is not raw:
            self._text = raw, _as_text(offer.type or offer.publishers[0].type, raw)
        return Inspected(topic, self._text[1], self.core.clock() - at)


def _as_text(type_name: str, raw: Raw) -> str:
    try:
        return to_text(decode(type_name, raw.cdr), MAX_LINES)
    except MessageError as error:
        return f"The last message cannot be read: {error}"
