"""The interface of recordings, and what is lost of damaged ones."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import Any, NamedTuple, Protocol

import msgspec
import numpy as np
import numpy.typing as npt

DEFINITION_ENCODINGS = ("ros2msg", "ros2idl")
"""Encodings of the definitions that are read."""


class RecordingError(Exception):
    """A recording cannot be opened; one sentence with a remedy."""


class BrokenRecord(Exception):
    """A record of a file is damaged, or cut off."""


class RecordedChannel(msgspec.Struct, frozen=True):
    """Messages of one type on one topic.

    Args:
        topic: full name.
        type: message type as recorded, such as "std_msgs/msg/String" or "std_msgs/String".
        encoding: of the messages; "cdr" for those of ROS 2.
        definition: of the type, as .msg text or IDL; "" if there is none.
        profiles: the QoS that publishers offered, as YAML; "" if unknown.
    """

    topic: str
    type: str
    encoding: str
    definition: str
    profiles: str


class RecordedMessage(NamedTuple):
    """One recorded message.

    Args:
        channel: of its topic and type.
        stamp_ns: time of recording.
        data: the serialised message.
    """

    channel: RecordedChannel
    stamp_ns: int
    data: bytes


class TimeParts(msgspec.Struct, frozen=True):
    """Equal parts of a span of time.

    Args:
        start_ns, end_ns: the span.
        count: number of parts.
    """

    start_ns: int
    end_ns: int
    count: int

    @property
    def length_ns(self) -> int:
        """Duration of a part."""
        return max(1, -(-(self.end_ns - self.start_ns + 1) // self.count))

    def part_of(self, stamps_ns: npt.NDArray[np.uint64]) -> npt.NDArray[np.int64]:
        """Return the numbers of the parts that times lie in.

        Those outside belong to the outermost.
        """
        first_ns = max(0, self.start_ns)  # a span that was moved may begin before all times
        clipped = np.clip(stamps_ns, np.uint64(first_ns), np.uint64(max(first_ns, self.end_ns)))
        inside = clipped - np.uint64(self.start_ns % (1 << 64))
        return np.minimum(inside // np.uint64(self.length_ns), self.count - 1).astype(np.int64)


Counts = npt.NDArray[np.int64]
"""Messages in each part of a span."""


class Recording(Protocol):
    """A file or folder of messages."""

    channels: tuple[RecordedChannel, ...]
    span_ns: tuple[int, int] | None
    """Stamps of the first and the last message; None if there is no message."""

    @property
    def losses(self) -> Losses:
        """Parts that could not be read so far."""
        ...

    def messages(
        self, channels: Collection[RecordedChannel], start_ns: int, end_ns: int
    ) -> Iterator[RecordedMessage]:
        """Return the messages of some channels by time, both ends included.

        Skips what is damaged.
        """
        ...

    def newest(
        self, channels: Collection[RecordedChannel], end_ns: int
    ) -> Iterator[RecordedMessage]:
        """Return the messages of some channels until a time, the newest first.

        Skips what is damaged.
        """
        ...

    def newest_stamps(self, channels: Collection[RecordedChannel], end_ns: int) -> Iterator[int]:
        """Return the times of `newest` by the index, which may count damaged messages, too."""
        ...

    @property
    def used(self) -> frozenset[RecordedChannel]:
        """The channels that have messages, or may have if that takes long to find out."""
        ...

    def histogram(self, parts: TimeParts) -> dict[RecordedChannel, Counts]:
        """Count the messages of each channel by the index, estimated where it has only sums.

        May be called from any thread, before `close`.

        Raises:
            OSError: the file cannot be read.
        """
        ...

    def close(self) -> None:
        """Close all files."""
        ...


class Losses(msgspec.Struct):
    """Parts of a recording that cannot be read.

    Args:
        unit: what may be lost, such as "message".
        how: what happens to it, such as "skipped".
        skipped: the reasons, by place.
        others: further losses.
        notes: what else is unusual, in sentences.
    """

    unit: str
    how: str
    skipped: dict[Any, str] = msgspec.field(default_factory=dict)
    others: list[str] = msgspec.field(default_factory=list)
    notes: list[str] = msgspec.field(default_factory=list)

    @property
    def is_unfinished(self) -> bool:
        """Return whether nothing but the end is missing, as while a recording goes on."""
        return not self.skipped and set(self.others) == {END_MISSING}

    def __str__(self) -> str:
        """All losses as a clause, "" without any."""
        parts = list(self.others)
        if count := len(self.skipped):
            reason = next(iter(self.skipped.values()))
            if count == 1:
                sentence = f"1 {self.unit} is {self.how} ({reason})"
            else:
                sentence = f"{count} {self.unit}s are {self.how} (the first because {reason})"
            parts.insert(0, sentence)
        return ", and ".join(parts)


END_MISSING = "its end is missing"
MAX_DEFINITIONS = 64 << 20
"""Bytes of all names, definitions and QoS profiles of a recording; real ones have under 1 MB."""


class TextAllowance:
    """Counts the bytes of texts that are kept of one recording."""

    def __init__(self) -> None:
        self._left = MAX_DEFINITIONS

    def take(self, *sizes: int) -> bool:
        """Return whether texts of these sizes may be kept, too."""
        self._left -= sum(sizes)
        return self._left >= 0
