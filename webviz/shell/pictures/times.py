"""Times of a bag as people write them: seconds from its start, stamps, `start`, `end`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Protocol

from webviz.api.errors import Error

At = float | str
"""Seconds from the start of a bag; above 1e9 seconds since 1970; "start" or "end"."""
ABSOLUTE_S = 1e9
MAX_TIMES = 2000


class TimeError(Error):
    """A time cannot be used; one sentence."""


class Span(Protocol):
    """What has a first and a last message, in nanoseconds."""

    @property
    def start_ns(self) -> int:
        """Stamp of the first one."""
        ...

    @property
    def end_ns(self) -> int:
        """Stamp of the last one."""
        ...


def read_at(text: str) -> At:
    """A time as it is written on a command line.

    Raises:
        TimeError: it is none.
    """
    if text in ("start", "end"):
        return text
    try:
        seconds = float(text)
    except ValueError:
        seconds = math.nan
    if not math.isfinite(seconds):
        raise TimeError(f"{text!r} is not a valid time. Give seconds, `start` or `end`.")
    return seconds


def position_ns(at: At, span: Span, name: str) -> int:
    """Where in a bag a time is, in nanoseconds since 1970.

    Args:
        at: the time.
        span: of the bag.
        name: of the bag.

    Raises:
        TimeError: it is outside; the sentence tells the range.
    """
    if isinstance(at, str):
        at = read_at(at)
    if at == "start":
        return span.start_ns
    if at == "end":
        return span.end_ns
    assert not isinstance(at, str)
    offset_ns = span.start_ns if at < ABSOLUTE_S else 0
    wanted_ns = offset_ns + round(at * 1e9)
    # Stamps in seconds are floats, which are exact to some hundred nanoseconds only.
    slack_ns = 1_000
    if not span.start_ns - slack_ns <= wanted_ns <= span.end_ns + slack_ns:
        duration_s = seconds_from_start(span.end_ns, span)
        raise TimeError(
            f"{at:g} s is outside of {name}. Give 0 to {math.floor(duration_s * 1e3) / 1e3:g} s "
            f"from its start, or a stamp from {span.start_ns / 1e9:.3f} to "
            f"{span.end_ns / 1e9:.3f}."
        )
    return min(max(wanted_ns, span.start_ns), span.end_ns)


def seconds_from_start(position_ns: int, span: Span) -> float:
    """The reverse of `position_ns`."""
    return (position_ns - span.start_ns) / 1e9


def every(first: At, last: At, step_s: float, span: Span, name: str) -> Sequence[float]:
    """Times at equal distances, in seconds from the start of a bag; the last one included.

    Raises:
        TimeError: a time is outside, or there are too many or none.
    """
    begin, end = (seconds_from_start(position_ns(at, span, name), span) for at in (first, last))
    if begin > end:
        raise TimeError(f"--from {begin:g} s is later than --to {end:g} s. Swap them.")
    count = math.floor((end - begin) / step_s + 1e-6) + 1
    if count > MAX_TIMES:
        raise TimeError(f"That makes {count} pictures; the limit is {MAX_TIMES}. Raise --every.")
    return [begin + index * step_s for index in range(count)]
