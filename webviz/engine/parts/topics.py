"""Traffic of topics: who publishes them, and rates."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from typing import Any

from webviz.data.messages import MessageError, peek_header
from webviz.engine.parts.part import Batches, Core, Part
from webviz.engine.state import Traffic
from webviz.sources import Offer, Raw

SPAN_S = 3.0
"""Over how long a rate is measured."""
MEASURED_S = 0.5
EVERY_S = 1.0
"""Interval between measurements of a delay."""


class TopicsPart(Part):
    """Who publishes what, and how fast it arrives."""

    name = "Topics"

    def __init__(self, core: Core) -> None:
        super().__init__(core)
        self._offers: Mapping[str, Offer] | None = None
        self._types: dict[str, tuple[str, ...]] = {}
        self._counts: deque[tuple[float, dict[str, tuple[int, int]]]] = deque()
        self._shown: dict[str, Traffic] = {}
        self._delays: dict[str, tuple[float, float | None]] = {}

    def take(self, batches: Batches) -> None:
        """Measure delays."""
        for topic, batch in batches.items():
            if (newest := next(reversed(list(batch)), None)) is not None:
                self._measure(topic, newest)

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
        return {
            "topics": self._types,
            "offers": offers,
            "services": self.core.gate.services(),
            "traffic": self._traffic(),
        }

    def _measure(self, topic: str, raw: Raw) -> None:
        """Note how old a message was when it came, now and then."""
        now = self.core.clock()
        if now - self._delays.get(topic, (-EVERY_S, None))[0] < EVERY_S:
            return
        offer = self.core.offers.get(topic)
        try:
            type_ = type_of(offer) if offer else ""
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


def type_of(offer: Offer) -> str:
    """Return the type its messages are decoded as."""
    return offer.type or (offer.publishers[0].type if offer.publishers else "")
