"""A bag file: its channels, and its messages in the order of time."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from pathlib import Path

import msgspec
from msgspec.structs import replace

from webviz.api.errors import Error
from webviz.api.offer import Publisher
from webviz.data.foxglove.schemas import Conversion, ConversionError, conversion, is_own, problem_of
from webviz.data.messages import (
    KNOWN,
    DefinitionError,
    MessageError,
    MessageTypes,
    UnknownTypeError,
    defined,
    definition,
    type_exists,
)
from webviz.data.messages.distributions import (
    OtherLayout,
    UndefinedMessages,
    definition_elsewhere,
    may_differ,
)
from webviz.data.messages.typestore import fields, full_name
from webviz.data.names import problem_of as name_problem
from webviz.data.recordings import RecordedChannel, RecordingError, open_recording
from webviz.data.recordings.recording import Counts, RecordedMessage, TimeParts
from webviz.sources.bag.qos import profiles_of
from webviz.sources.history import Recorded
from webviz.sources.names import MAX_NAME

Layout = OtherLayout | UndefinedMessages

KEEP_LAST = 1
"""Latched messages per publisher if the bag does not record the depth."""


class BagError(Error):
    """A bag cannot be read; one sentence with a remedy."""


class BagChannel(msgspec.Struct, frozen=True):
    """Messages of one type on one topic.

    Args:
        topic: full name.
        type: three-part name.
        publishers: recorded QoS.
        depth: how many messages its publishers latch in total.
        recorded: as it is in the file.
        conversion: to that type, None for messages of ROS.
        types: that define that type.
        layout: by which another distribution wrote its messages, None for that of `types`.
    """

    topic: str
    type: str
    publishers: tuple[Publisher, ...]
    depth: int
    recorded: RecordedChannel
    conversion: Conversion | None = None
    types: MessageTypes = KNOWN
    layout: Layout | None = None

    @property
    def written(self) -> RecordedChannel:
        """Channel as it is written to other files, in CDR."""
        if self.conversion is None and self.layout is None and self.recorded.definition:
            return self.recorded
        is_known = type_exists(self.type)
        text = definition(self.type) if is_known else definition_elsewhere(self.type)
        return replace(self.recorded, type=self.type, encoding="cdr", definition=text)

    def cdr(self, data: bytes) -> bytes:
        """Return a message in CDR; raises ConversionError if it is not of its type."""
        if self.layout is not None:
            try:
                return self.layout.to_cdr(data)
            except MessageError as error:
                raise ConversionError(str(error).rstrip(".")) from error
        if self.conversion is None:
            return data
        return self.conversion.convert(self.recorded.encoding, data)


class BagFile:
    """An mcap file, a db3 file or a rosbag2 folder, opened.

    Args:
        path: of the file or folder.

    Raises:
        BagError: it is missing, not a bag, without a whole message or empty.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.name = path.name
        if not path.exists():
            raise BagError(f"Bag {path} not found. Give an MCAP or db3 file, or a rosbag2 folder.")
        try:
            self._recording = open_recording(path)
        except RecordingError as error:
            raise BagError(str(error)) from error
        except OSError as error:
            raise BagError(self._unreadable(error)) from error
        if self._recording.span_ns is None:
            losses = str(self._recording.losses)
            self.close()
            if losses:
                raise BagError(f"{path} is damaged, and no message in it is whole: {losses}.")
            raise BagError(f"{path} contains no messages. Record it again or choose another bag.")
        self.start_ns, self.end_ns = self._recording.span_ns
        """Stamps of the first and the last message."""
        self._used = self._recording.used
        self.channels: tuple[BagChannel, ...] = ()
        self.skipped: dict[str, str] = {}
        """Reasons why messages cannot be read, by topic."""
        self._misfits: dict[str, str] = {}
        """Reason why the last message of a topic that could not be converted was left out, by
        topic."""
        self._look()

    @property
    def warnings(self) -> list[str]:
        """Return sentences on what is missing, unusual or damaged so far."""
        losses = self._recording.losses
        misfits = [f"{topic}: {reason}; it is left out." for topic, reason in self._misfits.items()]
        if losses.is_unfinished:
            unfinished = (
                f"{self.name} has no end: it is still being recorded or was cut off. What "
                "it contained when it was opened is shown. Once its recorder has ended, `webviz "
                "recover` completes a copy."
            )
            return [*losses.notes, *misfits, unfinished]
        loss_text = str(losses)
        damage = f"{self.name} is damaged: {loss_text}; everything else is shown."
        return [*losses.notes, *misfits, *([damage] if loss_text else [])]

    def messages(
        self, channels: Collection[BagChannel], start_ns: int, end_ns: int | None = None
    ) -> Iterator[Recorded]:
        """Yield the messages of channels by time of recording, both ends included.

        What is damaged is skipped, and `warnings` report it.

        Raises:
            BagError: the file can no longer be read.
        """
        by_recorded = {channel.recorded: channel for channel in channels}
        end_ns = self.end_ns if end_ns is None else end_ns
        try:
            entries = self._recording.messages(by_recorded.keys(), start_ns, end_ns)
            yield from self._converted(entries, by_recorded)
        except OSError as error:
            raise BagError(self._unreadable(error)) from error

    def newest(self, channels: Collection[BagChannel], end_ns: int) -> Iterator[Recorded]:
        """Yield the messages of channels until a time of recording, the newest first.

        Raises:
            BagError: the file can no longer be read.
        """
        by_recorded = {channel.recorded: channel for channel in channels}
        try:
            entries = self._recording.newest(by_recorded.keys(), end_ns)
            yield from self._converted(entries, by_recorded)
        except OSError as error:
            raise BagError(self._unreadable(error)) from error

    def newest_stamps(self, channels: Collection[BagChannel], end_ns: int) -> Iterator[int]:
        """Yield the times of recording of `newest`, without reading the messages.

        Raises:
            BagError: the file can no longer be read.
        """
        try:
            recorded = [channel.recorded for channel in channels]
            yield from self._recording.newest_stamps(recorded, end_ns)
        except OSError as error:
            raise BagError(self._unreadable(error)) from error

    def is_used(self, channel: BagChannel) -> bool:
        """Return whether a channel has messages, or may have."""
        return channel.recorded in self._used

    def histogram(self, parts: TimeParts) -> dict[str, Counts]:
        """Count the messages of each topic that can be read; see `Recording.histogram`.

        Raises:
            OSError: the file cannot be read.
        """
        histogram: dict[str, Counts] = {}
        counts = self._recording.histogram(parts)
        for channel in self.channels:
            own = counts[channel.recorded]
            histogram[channel.topic] = (
                histogram[channel.topic] + own if channel.topic in histogram else own
            )
        return histogram

    def close(self) -> None:
        """Close the file."""
        self._recording.close()

    def _converted(
        self, entries: Iterable[RecordedMessage], channels: Mapping[RecordedChannel, BagChannel]
    ) -> Iterator[Recorded]:
        for entry in entries:
            channel = channels[entry.channel]
            try:
                cdr = channel.cdr(entry.data)
            except ConversionError as error:
                self._misfits[channel.topic] = str(error)
                continue
            yield Recorded(channel.topic, channel.type, cdr, entry.stamp_ns, channel.types)

    def _unreadable(self, error: OSError) -> str:
        return f"Cannot read {self.path}: {error.strerror or error}."

    def _look(self) -> None:
        channels = []
        names = {recorded.topic for recorded in self._recording.channels}
        for recorded in self._recording.channels:
            # Some writers leave out the first slash, with which displays name topics.
            rooted = f"/{recorded.topic.removeprefix('/')}"
            topic = recorded.topic if rooted in names else rooted
            if reason := _obstacle(recorded):
                self.skipped[topic] = reason
                continue
            try:
                channels.append(_channel(topic, recorded, f"the bag {self.name}"))
            except MessageError as error:
                self.skipped[topic] = str(error).rstrip(".")
        self.channels = tuple(channels)


def _obstacle(recorded: RecordedChannel) -> str:
    """Return why the messages of a channel cannot be read whatever their type, "" if they can."""
    if is_own(recorded.type, recorded.encoding):
        if len(recorded.topic) > MAX_NAME or name_problem(recorded.topic):
            return "its name is too long, or contains invisible characters"
        return problem_of(recorded.type, recorded.type)
    if recorded.encoding != "cdr":
        return f"its messages are encoded as {recorded.encoding}, not as CDR"
    if recorded.type.endswith("_Event") and "/srv/" in recorded.type:
        return "service events are unsupported"
    return ""


def _channel(topic: str, recorded: RecordedChannel, who: str) -> BagChannel:
    """Return a channel as it is read.

    Raises:
        MessageError: its messages cannot be read; why, as a sentence.
    """
    conversion_of = conversion(recorded.type) if is_own(recorded.type, recorded.encoding) else None
    type_name = conversion_of.type if conversion_of else full_name(recorded.type)
    types, layout = (KNOWN, None) if conversion_of else _types(type_name, recorded.definition)
    profiles = profiles_of(recorded.profiles)
    publishers = tuple(Publisher(who, type_name, p.reliability, p.durability) for p in profiles)
    return BagChannel(
        topic,
        type_name,
        publishers or (Publisher(who, type_name, "reliable", "volatile"),),
        sum(max(profile.depth, KEEP_LAST) for profile in profiles) or KEEP_LAST,
        recorded,
        conversion_of,
        types,
        layout,
    )


def _types(name: str, text: str) -> tuple[MessageTypes, Layout | None]:
    """Return what defines a type, and the layout of its messages if it is another one.

    Args:
        name: full name of the type.
        text: its definition in the bag, "" if there is none.

    Raises:
        MessageError: its messages cannot be read; why, as a sentence.
    """
    text = text if text.strip() else ""
    if not type_exists(name):
        if not (text := text or definition_elsewhere(name)):
            raise UnknownTypeError(f"{name} is unknown, and the bag has no .msg definition of it.")
        types = defined(name, text)
        fields(name, types)
        return types, None
    if not may_differ(name):  # read when it is needed
        return (defined(name, text) if text else KNOWN), None
    if not text:
        return KNOWN, UndefinedMessages(name)
    types = defined(name, text)
    try:
        fields(name, types)
    except DefinitionError:
        return KNOWN, OtherLayout(name, text)
    return types, None
