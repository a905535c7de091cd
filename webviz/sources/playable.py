"""The interface of sources whose messages can be played again."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol, runtime_checkable

from webviz.sources.past_state import Event


@runtime_checkable
class Playable(Protocol):
    """A source that has a past, besides `webviz.sources.Source`.

    Positions are times of recording in ns since 1970. Everything recorded until the position has
    arrived in the inbox. Only the frame loop calls these methods.
    """

    @property
    def absence(self) -> str:
        """Return why there is no past to play, in sentences; "" if there is one."""
        ...

    @property
    def is_live(self) -> bool:
        """Return whether what arrives is shown, instead of a position; never of a bag."""
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
    def end_ns(self) -> int:
        """Time of the last message; now of live topics."""
        ...

    @property
    def gap_ns(self) -> tuple[int, int] | None:
        """Return the span in between that was forgotten while the past was shown, if any."""
        ...

    @property
    def position_ns(self) -> int:
        """The position; just before the start until something is played."""
        ...

    @property
    def names(self) -> Sequence[str]:
        """Names of the recordings, for people."""
        ...

    @property
    def warnings(self) -> Sequence[str]:
        """Sentences on what is missing, unusual or damaged, for people."""
        ...

    def play(self, until_ns: int) -> None:
        """Deliver everything recorded until a time, or a part of it that the inbox can hold.

        `position_ns` says how far that is; the next call continues.
        """
        ...

    def play_step(self, until_ns: int) -> None:
        """Play a short step towards a time, or up to the next message if that is later."""
        ...

    def seek(self, at_ns: int) -> None:
        """Go to a position from which playing to `at_ns` shows all that is to be seen there.

        Messages that wait in the inbox are discarded; the caller discards all other received data.
        """
        ...

    def rejoin(self, at_once: bool = False) -> bool:
        """Become live if the position is as good as now, or `at_once`; whether it is."""
        ...

    def neighbour(self, topic: str, is_forward: bool) -> int | None:
        """Return the time of the next or previous message of a topic, seen from the position.

        Args:
            topic: full name; "" is every subscribed topic but those of transforms and time.
            is_forward: the next message later than the position, or else the last one earlier.

        Returns:
            None if there is no such message.
        """
        ...

    def histogram(self, buckets: int) -> Mapping[str, Sequence[int]]:
        """Count the messages of each topic in equal parts of the span, as far as they are known.

        Args:
            buckets: number of parts, at least 1.

        Returns:
            Counts by topic, estimated where the index does not have them; the same mapping until
            something changes.
        """
        ...

    @property
    def counted_ns(self) -> tuple[int, int] | None:
        """Return the first and the last time of what `histogram` has counted, None for all."""
        ...

    def logged(self) -> Sequence[Event]:
        """Warnings and errors of nodes by time, bounded, as far as they are known.

        Returns:
            The same sequence until something changes.
        """
        ...
