"""Past messages on which the state of a display depends."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Lookback:
    """The messages of one input before a time that make up what is shown at that time.

    Without arguments, all of them. Each argument narrows it; a message that any of them leaves out
    is not read on a seek in a recording.

    Args:
        count: number of newest messages; 0 is unlimited.
        seconds: maximum time since arrival; 0 is unlimited.
        since: another input: only messages since the first one that is read of it count.
        starts_over: called with a message of this input and its type; returns whether none before
            it counts.
        chooses: called with an iterator of the messages that the above leave, the newest first,
            each decoded when it is asked for; returns which of these count, 0 for the newest.
    """

    count: int = 0
    seconds: float = 0.0
    since: str = ""
    starts_over: Callable[[Any, str], bool] | None = None
    chooses: Callable[[Iterator[Any]], Sequence[int]] | None = None
