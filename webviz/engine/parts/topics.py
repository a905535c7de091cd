"""Traffic of topics: rates, and the last messages of inspected ones."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Mapping
from typing import Any

from webviz.api.declared import Topic
from webviz.data.messages import MessageError, decode, peek_header, to_tree
from webviz.engine.commands import Command, InspectTopic, InspectTopics, Sender
from webviz.engine.parts.part import Batches, Core, Handler, Part
from webviz.engine.state import Inspected, Traffic
from webviz.sources import Offer, Raw, Subscriber, Subscription

SPAN_S = 3.0
"""Over how long a rate is measured."""
MEASURED_S = 0.5
EVERY_S = 1.0
"""Interval between readings of an inspected message."""
MAX_INSPECTED = 64
"""Topics that are looked into at once."""


class TopicsPart(Part):
    """Who publishes what, how fast it arrives, and the last messages of some topics."""

    name = "Topics"

    def __init__(self, core: Core) -> None:
        super().__init__(core)
        self._subscriber = Subscriber()
        self._own = ""
        self._of_pages: frozenset[str] = frozenset()
        self._offers: Mapping[str, Offer] | None = None
        self._types: dict[str, tuple[str, ...]] = {}
        self._counts: deque[tuple[float, dict[str, tuple[int, int]]]] = deque()
        self._shown: dict[str, Traffic] = {}
        self._delays: dict[str, tuple[float, float | None]] = {}
        self._last: dict[str, tuple[Raw, float]] = {}
        self._read: dict[str, tuple[float, Raw, Inspected]] = {}

    @property
    def handles(self) -> Mapping[type[Command], Handler]:
        """The handler of each command."""
        return {InspectTopic: self._inspect, InspectTopics: self._inspect_for_pages}

    def subscriptions(self) -> Mapping[str, Subscription]:
        """Return the topics that are inspected while a browser is open, with their first types."""
        inspected = self._inspected() if self.core.is_watched() else ()
        offers = {topic: self.core.offers.get(topic) for topic in inspected}
        return self._subscriber.subscribe(
            {
                topic: Subscription(offer.publishers[0].type, Topic(topic))
                for topic, offer in offers.items()
                if offer and offer.publishers
            }
        )

    def take(self, batches: Batches) -> None:
        """Keep the newest messages of the topics that are looked into, and measure delays."""
        inspected = self._inspected()
        for topic, batch in batches.items():
            newest = next(reversed(list(batch)), None)
            if newest is None:
                continue
            self._measure(topic, newest)
            if topic in inspected:
                self._last[topic] = newest, time.time()

    def reset(self) -> None:
        """Forget delays, which another time makes meaningless."""
        self._delays.clear()

    def state(self) -> Mapping[str, Any]:
        """All topics."""
        offers = self.core.offers
        if offers is not self._offers:
            self._offers = offers
            self._types = {
                topic: tuple(sorted({publisher.type for publisher in offer.publishers}))
                for topic, offer in offers.items()
            }
        inspected = self._inspected()
        for gone in self._last.keys() - inspected:
            del self._last[gone]
            self._read.pop(gone, None)
        return {
            "topics": self._types,
            "offers": offers,
            "services": self.core.gate.services(),
            "traffic": self._traffic(),
            "inspected": {topic: self._look(topic) for topic in inspected},
        }

    def _inspect(self, command: InspectTopic, sender: Sender) -> None:
        self._own = command.topic

    def _inspect_for_pages(self, command: InspectTopics, sender: Sender) -> None:
        self._of_pages = frozenset(sorted(command.topics)[:MAX_INSPECTED])

    def _inspected(self) -> set[str]:
        return {topic for topic in (self._own, *self._of_pages) if topic}

    def _measure(self, topic: str, raw: Raw) -> None:
        """Note how old a message was when it came, now and then."""
        now = self.core.clock()
        if now - self._delays.get(topic, (-EVERY_S, None))[0] < EVERY_S:
            return
        offer = self.core.offers.get(topic)
        try:
            type_ = _type_of(offer) if offer else ""
            header = peek_header(type_, raw.cdr, raw.types) if type_ else None
        except MessageError:
            header = None
        delay = (raw.received_ns - header[1]) / 1e9 if header and header[1] else None
        self._delays[topic] = now, delay

    def _traffic(self) -> dict[str, Traffic]:
        """Rates by topic over the last seconds, measured anew now and then."""
        now, counts = self.core.clock(), self.core.player.inbox.received()
        if self._counts and 0.0 <= now - self._counts[-1][0] < MEASURED_S:
            return {topic: each for topic, each in self._shown.items() if topic in counts}
        self._shown = self._rates(now, counts)
        return self._shown

    def _rates(self, now: float, counts: dict[str, tuple[int, int]]) -> dict[str, Traffic]:
        self._counts.append((now, counts))
        while len(self._counts) > 2 and now - self._counts[1][0] >= SPAN_S:
            self._counts.popleft()
        for gone in self._delays.keys() - counts.keys():
            del self._delays[gone]
        then, before = self._counts[0]
        if now == then:
            return {}
        traffic = {}
        for topic, (count, size) in counts.items():
            old_count, old_size = before.get(topic, (0, 0))
            if count < old_count:  # subscribed anew
                old_count = old_size = 0
            rates = (count - old_count) / (now - then), (size - old_size) / (now - then)
            traffic[topic] = Traffic(*rates, self._delays.get(topic, (0.0, None))[1])
        return traffic

    def _look(self, topic: str) -> Inspected:
        """Return the report on an inspected topic."""
        offer = self.core.offers.get(topic)
        type_ = _type_of(offer) if offer else ""
        if not offer or not offer.publishers:
            return Inspected(problem="No publisher on this topic.")
        if offer.problem:
            return Inspected(type_, problem=f"This topic cannot be read: {offer.problem}.")
        if topic not in self._last:
            return Inspected(type_, problem="No message has arrived yet.")
        raw, received_s = self._last[topic]
        now = self.core.clock()
        read = self._read.get(topic)
        if read is None or (read[1] is not raw and not 0.0 <= now - read[0] < EVERY_S):
            read = now, raw, _read(type_, raw, received_s)
            self._read[topic] = read
        return read[2]


def _type_of(offer: Offer) -> str:
    """Return the type its messages are decoded as."""
    return offer.type or (offer.publishers[0].type if offer.publishers else "")


def _read(type_name: str, raw: Raw, received_s: float) -> Inspected:
    size = len(raw.cdr)
    try:
        tree = to_tree(decode(type_name, raw.cdr, raw.types))
    except MessageError as error:
        problem = f"The last message cannot be read: {error}"
        return Inspected(type_name, None, problem, size, received_s)
    return Inspected(type_name, tree, "", size, received_s)
