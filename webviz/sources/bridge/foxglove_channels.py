"""The channels that a Foxglove server advertises, bounded in number and size."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from msgspec.structs import replace

from webviz.data.foxglove.schemas import conversion, is_own, problem_of
from webviz.data.words import listed, plain
from webviz.sources.bridge.foxglove_wire import ServerChannel
from webviz.sources.names import MAX_NAME, is_full_name

MAX_TOPICS = 10_000
MAX_SCHEMAS = 256 << 20
"""Characters of all definitions, each counted once."""
MAX_MISNAMED = 8
"""Invalid names that are remembered."""


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
    known = conversion(channel.schema_name) if is_foreign(channel) else None
    return known.type if known else channel.schema_name
