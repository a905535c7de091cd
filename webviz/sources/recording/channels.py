"""Channels of recordings, of the topics of a source."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from webviz.api.offer import Offer, Publisher
from webviz.data.messages import KNOWN, MessageError, MessageTypes, definition
from webviz.data.recordings import RecordedChannel
from webviz.sources.bag.log import ROSOUT
from webviz.sources.bag.qos import text_of


def library() -> str:
    """Return the name of the program, for the header of its recordings."""
    import importlib.metadata  # here, as it is slow

    return f"webviz {importlib.metadata.version('ros-webviz')}"


class Channels:
    """The channel of each topic, with the QoS that its publishers offered at first.

    Args:
        offers: publishers and QoS by topic, as they are now; called from any thread.
    """

    def __init__(self, offers: Callable[[], Mapping[str, Offer]]) -> None:
        self._offers = offers
        self._channels: dict[str, RecordedChannel] = {}
        self._types: dict[str, MessageTypes] = {}
        """Types that define them."""
        self._last_offers: Mapping[str, Offer] = {}
        self._latched: dict[str, int] = {}
        self._last: dict[str, Offer] = {}
        """Last graph of topics that had publishers."""

    def __len__(self) -> int:
        return len(self._channels)

    def find(self, topic: str, types: MessageTypes | None = None) -> RecordedChannel | None:
        """Return the channel of a topic, None while the type of its messages is unknown.

        Args:
            topic: full name.
            types: that define the type of a message; None for those of the last one.
        """
        channel = self._channels.get(topic)
        if channel is None or types not in (None, self._types[topic]):
            offer = self._offers().get(topic)
            if offer is None or not offer.publishers:  # they ended, but their messages are here
                offer = self._last.get(topic, offer)
            publishers = offer.publishers if offer else ()
            type_ = (offer.type if offer else "") or _type_of(publishers)
            if not type_:
                return None
            types = self._types[topic] = types or KNOWN
            channel = self._channels[topic] = _channel(topic, type_, publishers, types)
        return channel

    def look(self) -> None:
        """Note what topics are; to be called now and then, since publishers may end."""
        offers = self._offers()
        if offers is self._last_offers:
            return
        for topic, offer in offers.items():
            if offer.publishers:
                self._last[topic] = offer
            if topic == ROSOUT:
                continue  # latched by every node, but nothing that is still so
            count = sum(each.durability == "transient_local" for each in offer.publishers)
            if count:
                self._latched[topic] = max(count, self._latched.get(topic, 0))
        self._last_offers = offers

    def latched(self, topic: str) -> int:
        """Return the number of publishers of a topic that late subscribers hear from."""
        self.look()
        return self._latched.get(topic, 0)


def _type_of(publishers: Sequence[Publisher]) -> str:
    """Return the type that all publishers agree on, "" if they do not."""
    types = {publisher.type for publisher in publishers}
    return types.pop() if len(types) == 1 else ""


def _channel(
    topic: str, type_: str, publishers: Sequence[Publisher], types: MessageTypes
) -> RecordedChannel:
    try:
        text = definition(type_, types)
    except MessageError:
        text = ""
    return RecordedChannel(topic, type_, "cdr", text, text_of(publishers))
