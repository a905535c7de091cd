"""The past as data: bags, or the memory of live topics."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from typing import NamedTuple, Protocol

from webviz.api.offer import Offer
from webviz.data.messages import KNOWN, MessageTypes
from webviz.data.recordings.latched import TF
from webviz.sources.history.intervals import ValidityIntervals
from webviz.sources.past_state import Event
from webviz.sources.source import Subscription

CLOCK = "rosgraph_msgs/msg/Clock"
FOLLOWED = (TF, CLOCK)
"""Types of auxiliary messages, which stepping skips."""


class HistoryChannel(NamedTuple):
    """Messages of one type on one topic.

    Args:
        topic: full name.
        type: three-part name.
    """

    topic: str
    type: str


class Recorded(NamedTuple):
    """One message of the past.

    Args:
        topic: full name.
        type: three-part name.
        cdr: the serialised message.
        stamp_ns: time of recording.
        types: that define its type.
    """

    topic: str
    type: str
    cdr: bytes
    stamp_ns: int
    types: MessageTypes = KNOWN


class RecordedTime(Protocol):
    """ROS time during a history, for one reader that goes through its messages."""

    def seek(self, at_ns: int) -> None:
        """Go to a time of recording."""
        ...

    def take(self, recorded: Recorded) -> None:
        """Process a message of a channel of `History.channels`, in order."""
        ...

    def at(self, recorded_ns: int) -> int:
        """Return ROS time at a time of recording, both in ns."""
        ...


class History(Protocol):
    """Messages of the past by time; nothing here knows which time is shown.

    Times are times of recording in ns since 1970. Only the frame loop calls these methods.
    """

    wake: Callable[[], object]
    """Called from any thread when `histogram` or `logged` know more."""

    @property
    def is_growing(self) -> bool:
        """Return whether it is the memory of topics that are live, and ends now."""
        ...

    @property
    def names(self) -> Sequence[str]:
        """Names of the recordings, for people; none of a memory."""
        ...

    @property
    def origin_ns(self) -> int:
        """The time from which people count; not after the start."""
        ...

    @property
    def start_ns(self) -> int:
        """Time of the first message."""
        ...

    @property
    def last_ns(self) -> int:
        """Time of the last message."""
        ...

    @property
    def end_ns(self) -> int:
        """The same; of a memory now."""
        ...

    def refresh(self) -> bool:
        """Take in the messages that came since the last call; whether there are any."""
        ...

    def channels(self, subscriptions: Mapping[str, Subscription]) -> Sequence[HistoryChannel]:
        """Return what is to be read for subscriptions, by topic: theirs, and the clock."""
        ...

    def channels_of(self, topic: str) -> Sequence[HistoryChannel]:
        """Return the channels of a topic, whether it is subscribed to or not."""
        ...

    def messages(
        self, channels: Collection[HistoryChannel], start_ns: int, end_ns: int | None = None
    ) -> Iterator[Recorded]:
        """Return the messages of some channels by time, both ends included.

        Raises:
            BagError: a file can no longer be read; so do the others.
        """
        ...

    def newest(self, channels: Collection[HistoryChannel], end_ns: int) -> Iterator[Recorded]:
        """Return the messages of some channels until a time, the newest first."""
        ...

    def newest_stamps(self, channels: Collection[HistoryChannel], end_ns: int) -> Iterator[int]:
        """Return the times of `newest`, without reading the messages."""
        ...

    def first_ns(self, channel: HistoryChannel) -> int | None:
        """Return the time of the first message of a channel, None without any."""
        ...

    def latched(self, channel: HistoryChannel, is_wanted: bool) -> int:
        """Return the number of last messages that late subscribers receive.

        Args:
            channel: of the messages.
            is_wanted: whether the subscription is transient local, whatever publishers offer.
        """
        ...

    def validity(self) -> ValidityIntervals:
        """Return when frames have transforms, as far as that is known by now."""
        ...

    def time(self) -> RecordedTime:
        """Return ROS time for a new reader."""
        ...

    def offers(self, subscriptions: Mapping[str, Subscription]) -> Mapping[str, Offer]:
        """Return publishers and QoS by topic; another object only after a change.

        Args:
            subscriptions: by topic; the same object until they change.
        """
        ...

    def warnings(self, subscriptions: Mapping[str, Subscription]) -> Sequence[str]:
        """Return sentences on what is missing, unusual or damaged, for people."""
        ...

    def histogram(self, parts: int) -> Mapping[str, Sequence[int]]:
        """Count the messages of each topic in equal parts of the span, as far as they are known.

        Args:
            parts: their number, at least 1.

        Returns:
            Counts by topic, estimated where the index does not have them; the same mapping until
            something changes.
        """
        ...

    @property
    def counted_ns(self) -> tuple[int, int] | None:
        """The first and the last time of what `histogram` has counted, None for all."""
        ...

    @property
    def gap_ns(self) -> tuple[int, int] | None:
        """The span in between that was forgotten while the past was shown, if any."""
        ...

    def logged(self) -> Sequence[Event]:
        """Return warnings and errors of nodes by time, bounded, as far as they are known.

        Returns:
            The same sequence until something changes.
        """
        ...

    def resolve(self, topic: str) -> str:
        """Return the full name of a topic, remapped; those of a recording are valid.

        Raises:
            ValueError: it is not a valid topic name.
        """
        ...

    def close(self) -> None:
        """Close the files."""
        ...
