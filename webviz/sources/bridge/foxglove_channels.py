"""The other side of a Foxglove server: its channels, what is subscribed of them, and its nodes."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Mapping, Sequence

import msgspec
from msgspec.structs import replace

from webviz.data.foxglove.schemas import conversion, is_own, problem_of
from webviz.data.words import listed, plain
from webviz.sources.bridge import foxglove_wire as wire
from webviz.sources.bridge.foxglove_wire import ServerChannel
from webviz.sources.names import MAX_NAME, is_full_name

MAX_TOPICS = 10_000
MAX_SCHEMAS = 256 << 20
"""Characters of all definitions, each counted once."""
MAX_MISNAMED = 8
"""Invalid names that are remembered."""
MAX_NAMES = 100_000
"""Topics and services in the graph; more are ignored."""
MAX_ENDED = 100
"""Ended subscriptions whose messages are still taken."""


class ChannelSubscription(msgspec.Struct, frozen=True):
    """A subscription.

    Args:
        id: chosen by webviz.
        topic: of the channel.
        channel: its id.
        resubscriptions: of the subscription, see `webviz.sources.Subscription`.
    """

    id: int
    topic: str
    channel: int
    resubscriptions: int


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


class ConnectionGraph:
    """Publishers and subscribers by topic; it begins empty, and is updated by differences."""

    def __init__(self) -> None:
        self._publishers: dict[str, tuple[str, ...]] = {}
        self._subscribers: dict[str, tuple[str, ...]] = {}
        self._providers: dict[str, tuple[str, ...]] = {}
        self._is_known = False
        self.nodes: tuple[str, ...] = ()
        """Full names, sorted."""

    def update(self, change: wire.ConnectionGraphUpdate) -> None:
        """Apply a difference."""
        self._is_known = True
        for topic in change.removed_topics:
            self._publishers.pop(topic, None)
            self._subscribers.pop(topic, None)
        for service in change.removed_services:
            self._providers.pop(service, None)
        self._publishers |= {t.name: _names(t.publisher_ids) for t in change.published_topics}
        self._subscribers |= {t.name: _names(t.subscriber_ids) for t in change.subscribed_topics}
        self._providers |= {s.name: _names(s.provider_ids) for s in change.advertised_services}
        tables = (self._publishers, self._subscribers, self._providers)
        for table in tables:
            while len(table) > MAX_NAMES:
                table.popitem()
        self.nodes = tuple(
            sorted({n for table in tables for names in table.values() for n in names})
        )

    def publishers(self, topic: str) -> tuple[str, ...]:
        """Return the nodes that publish a topic."""
        return self._publishers.get(topic, ())

    def subscribers(self, topic: str) -> tuple[str, ...] | None:
        """Return the nodes that subscribe to a topic, None if the graph is unknown."""
        return self._subscribers.get(topic, ()) if self._is_known else None


def _names(ids: tuple[str, ...]) -> tuple[str, ...]:
    """Node names; ids of some servers that are not valid names are kept unchanged."""
    return tuple(sorted(set(ids)))


class FoxgloveChannels:
    """The channels by topic, of which each has one or, with several types, several."""

    def __init__(self) -> None:
        self._channels: dict[int, ServerChannel] = {}
        self._by_topic: dict[str, list[ServerChannel]] = {}
        self._schemas: dict[str, str] = {}
        """Definitions, each once however many channels have it."""
        self._size = 0
        self._left_out = 0
        self._misnamed: dict[str, None] = {}

    @property
    def by_topic(self) -> Mapping[str, Sequence[ServerChannel]]:
        """All channels."""
        return self._by_topic

    def remarks(self) -> list[str]:
        """Sentences about channels that are left out."""
        left_out = (
            f"The bridge offers more than {MAX_TOPICS} topics, or too many definitions: "
            f"{self._left_out} topics are left out. Choose topics with the parameter "
            "topic_whitelist of foxglove_bridge."
        )
        misnamed = (
            "Topics whose names ROS does not allow are left out: "
            f"{listed([plain(name, 40) for name in self._misnamed], 3)}."
        )
        return [*([left_out] if self._left_out else []), *([misnamed] if self._misnamed else [])]

    def add(self, channel: ServerChannel) -> None:
        """Add a channel, in the place of that with its id."""
        self.remove(channel.id)
        if not is_full_name(channel.topic) or len(channel.schema_name) > MAX_NAME:
            if len(self._misnamed) < MAX_MISNAMED:
                self._misnamed[channel.topic[:MAX_NAME]] = None
            return
        size = 0 if channel.schema in self._schemas else len(channel.schema)
        if len(self._channels) >= MAX_TOPICS or self._size + size > MAX_SCHEMAS:
            self._left_out += 1
            return
        self._size += size
        text = self._schemas.setdefault(channel.schema, channel.schema)
        channel = self._channels[channel.id] = replace(channel, schema=text)
        self._by_topic.setdefault(channel.topic, []).append(channel)

    def remove(self, id: int) -> None:
        """Remove a channel."""
        channel = self._channels.pop(id, None)
        if channel is None:
            return
        rest = [each for each in self._by_topic[channel.topic] if each.id != id]
        if rest:
            self._by_topic[channel.topic] = rest
        else:
            del self._by_topic[channel.topic]


def unread(channel: ServerChannel) -> str:
    """Return why the messages of a channel cannot be read, "" if they can."""
    name = plain(channel.schema_name, 60)
    if channel.encoding == "cdr":
        schema = channel.schema_encoding or "ros2msg"
        if schema in ("ros2msg", "ros2idl"):
            return ""
        return f"{name} is defined as {plain(schema, 20)!r}, webviz reads ros2msg and ros2idl"
    if is_foreign(channel):
        return problem_of(channel.schema_name, name)
    if channel.encoding == "ros1":
        return f"{name} is a message of ROS 1, webviz shows ROS 2"
    return f"{name} comes as {plain(channel.encoding, 20)!r}, no display reads that"


def is_foreign(channel: ServerChannel) -> bool:
    """Return whether the messages of a channel are in one of Foxglove's own schemas."""
    return is_own(channel.schema_name, channel.encoding)


def type_of(channel: ServerChannel) -> str:
    """Return the message type of ROS of what a channel has."""
    converter = conversion(channel.schema_name) if is_foreign(channel) else None
    return converter.type if converter else channel.schema_name
