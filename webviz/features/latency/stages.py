"""Latencies of displays: where the time from a stamp to the browsers goes."""

from __future__ import annotations

from collections.abc import Iterable

import msgspec


class Stage(msgspec.Struct, frozen=True):
    """One step of samples on their way, in seconds to a hundredth of a millisecond.

    Args:
        name: such as "decoded", a time of `Trace`.
        begin: median of the time from the stamp, or the arrival, to its begin.
        p50, p99: median and 99th percentile of its duration.
    """

    name: str
    begin: float
    p50: float
    p99: float


class BrowserLatency(msgspec.Struct, frozen=True):
    """The rest of the way, to the screen of one browser.

    Args:
        browser: id of the browser.
        name: of the browser, for people.
        stages: "acknowledged" and "painted", which begin when samples were sent; none before the
            browser has answered.
        p50, p99: median and 99th percentile of the time from the stamp, or the arrival, to the
            painted frame, in seconds; 0 before it has answered.
        bytes_per_s: that the display takes of the link.
    """

    browser: int
    name: str
    stages: tuple[Stage, ...]
    p50: float
    p99: float
    bytes_per_s: float


class Latency(msgspec.Struct, frozen=True):
    """The last samples of a display.

    Args:
        id, name: of the display.
        samples: number of traced samples.
        stages: in order; those of messages without a stamp begin with their arrival.
        p50, p99: median and 99th percentile of the time from the stamp to sending, in seconds.
        waits_for: the transform that samples wait for, a sentence; "" if they do not.
        core: share of a processor that it takes to read and draw.
        browsers: the rest of the way, for each browser.
    """

    id: str
    name: str
    samples: int
    stages: tuple[Stage, ...]
    p50: float
    p99: float
    waits_for: str
    core: float
    browsers: tuple[BrowserLatency, ...]


def stages_of(
    names: Iterable[str], begins: Iterable[float], p50: Iterable[float], p99: Iterable[float]
) -> tuple[Stage, ...]:
    """Return the stages of these names, begins and percentiles, in seconds."""
    rows = zip(names, begins, p50, p99, strict=True)
    return tuple(Stage(name, *(round(each, 5) for each in times)) for name, *times in rows)
