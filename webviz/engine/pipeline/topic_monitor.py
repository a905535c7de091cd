"""What arrives on topics: rates, and the last message of one that somebody looks into."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Mapping

from webviz.api.declared import Topic
from webviz.data.messages import MessageError, decode, to_text
from webviz.engine.sources import Inbox, Offer, Raw, Subscription
from webviz.engine.state import Inspected, Traffic

SPAN_S = 3.0
"""Over how long a rate is measured."""
MAX_LINES = 60


class TopicMonitor:
    """Watches an inbox.

    Args:
        inbox: where messages arrive.
        clock: monotonic time in seconds.
    """

    def __init__(self, inbox: Inbox, clock: Callable[[], float]) -> None:
        self.inspected = ""
        """The topic to look into, "" for none."""
        self._inbox = inbox
        self._clock = clock
        self._counts: deque[tuple[float, dict[str, tuple[int, int]]]] = deque()
        self._last: tuple[str, Raw, float] | None = None
        self._text: tuple[Raw, str] | None = None

    def subscription(self, offers: Mapping[str, Offer]) -> dict[str, Subscription]:
        """What to hear of the topic that is looked into, as the first type it is published as."""
        offer = offers.get(self.inspected)
        if not offer or not offer.publishers:
            return {}
        return {self.inspected: Subscription(offer.publishers[0].type, Topic(self.inspected))}

    def take(self, batches: Mapping[str, Iterable[Raw]]) -> None:
        """Keep the newest message of the topic that is looked into."""
        for raw in batches.get(self.inspected, ()):
            self._last = self.inspected, raw, self._clock()

    def traffic(self) -> dict[str, Traffic]:
        """Rates by topic, since some seconds ago; to be called some times a second."""
        now, counts = self._clock(), self._inbox.received()
        self._counts.append((now, counts))
        while len(self._counts) > 2 and now - self._counts[1][0] >= SPAN_S:
            self._counts.popleft()
        then, before = self._counts[0]
        if now == then:
            return {}
        traffic = {}
        for topic, (count, size) in counts.items():
            old_count, old_size = before.get(topic, (0, 0))
            if count < old_count:  # subscribed anew
                old_count = old_size = 0
            span = now - then
            traffic[topic] = Traffic((count - old_count) / span, (size - old_size) / span)
        return traffic

    def look(self, offers: Mapping[str, Offer]) -> Inspected | None:
        """The topic that is looked into, with its last message as text."""
        topic = self.inspected
        if not topic:
            return None
        offer = offers.get(topic)
        if not offer or not offer.publishers:
            return Inspected(topic, "Nobody publishes this topic.")
        if offer.problem:
            return Inspected(topic, f"This topic cannot be read: {offer.problem}.")
        if self._last is None or self._last[0] != topic:
            return Inspected(topic, "No message has come yet.")
        _, raw, at = self._last
        if self._text is None or self._text[0] is not raw:
            self._text = raw, self._as_text(offer.type or offer.publishers[0].type, raw)
        return Inspected(topic, self._text[1], self._clock() - at)

    def _as_text(self, type_name: str, raw: Raw) -> str:
        try:
            return to_text(decode(type_name, raw.cdr), MAX_LINES)
        except MessageError as error:
            return f"The last message cannot be read: {error}"
