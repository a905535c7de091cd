"""Times of a bag in the forms that users write: seconds, Unix times, `start` and `end`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from numbers import Real
from typing import Protocol

from webviz.api.errors import Error
from webviz.data.words import number_in

At = float | str
"""Seconds from the start of a bag, a Unix time (above 1e9), "start" or "end"."""
ABSOLUTE_S = 1e9
MAX_TIMES = 2000


class TimeError(Error):
    """A time is invalid or outside of the bag."""


class Span(Protocol):
    """A recording."""

    @property
    def start_ns(self) -> int:
        """Time of the first message in ns."""
        ...

    @property
    def end_ns(self) -> int:
        """Time of the last message in ns."""
        ...


def read_at(text: str) -> At:
    """Parse a time of the command line.

    Raises:
        TimeError: it is invalid.
    """
    if text in ("start", "end"):
        return text
    seconds = number_in(text)
    if seconds is None:
        raise TimeError(f"{text!r} is not a valid time. Give seconds, `start` or `end`.")
    return seconds


def position_ns(at: At, span: Span, name: str) -> int:
    """Return a time of a bag in nanoseconds since 1970.

    Args:
        at: the time.
        span: of the bag.
        name: of the bag, for errors.

    Raises:
        TimeError: it is invalid or outside of the bag.
    """
    if isinstance(at, str):
        at = read_at(at)
    if at == "start":
        return span.start_ns
    if at == "end":
        return span.end_ns
    if isinstance(at, str) or not isinstance(at, Real) or not math.isfinite(at):
        raise TimeError(f"{at} is not a valid time. Give seconds, `start` or `end`.")
    offset_ns = span.start_ns if at < ABSOLUTE_S else 0
    wanted_ns = offset_ns + round(at * 1e9)
    # Unix times as floats are accurate to some hundred nanoseconds only.
    slack_ns = 1_000
    if not span.start_ns - slack_ns <= wanted_ns <= span.end_ns + slack_ns:
        duration_s = seconds_from_start(span.end_ns, span)
        raise TimeError(
            f"{at:g} s is outside of {name}. Give 0 to {math.floor(duration_s * 1e3) / 1e3:g} s "
            f"from its start, or a Unix time from {span.start_ns / 1e9:.3f} to "
            f"{span.end_ns / 1e9:.3f}."
        )
    return min(max(wanted_ns, span.start_ns), span.end_ns)


def seconds_from_start(position_ns: int, span: Span) -> float:
    """Return the inverse of `position_ns`."""
    return (position_ns - span.start_ns) / 1e9


def every(first: At, last: At, step_s: float, span: Span, name: str) -> Sequence[float]:
    """Return times in equal steps, in seconds from the start of a bag, including `last`.

    Those that would mean a Unix time, in a bag of decades, are Unix times.

    Raises:
        TimeError: a time is outside of the bag, or there are none or too many.
    """
    begin, end = (seconds_from_start(position_ns(at, span, name), span) for at in (first, last))
    if begin > end:
        raise TimeError(f"--from {begin:g} s is later than --to {end:g} s. Swap them.")
    steps = (end - begin) / step_s + 1e-6
    count = math.floor(min(steps, 1e18)) + 1
    if count > MAX_TIMES:
        raise TimeError(f"That makes {count} pictures; the limit is {MAX_TIMES}. Raise --every.")
    times = [begin + index * step_s for index in range(count)]
    return [each if each < ABSOLUTE_S else span.start_ns / 1e9 + each for each in times]
