"""Moments of a bag at which to look, in steps that grow where nothing is recorded.

A clock that is set while it records makes a bag of decades of a few messages, and a robot may be
silent for a year: the number of steps follows from the messages, never from the span.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from webviz.sources.player import Player

EVEN_STEPS = 100
"""Steps of equal length after a message; from then on each is longer than the one before."""
GROWTH = 4
"""A step is at most this part of the time since they were equal."""


def steps_of(player: Player, first_ns: int, last_ns: int, step_ns: float) -> Iterator[int]:
    """Yield times of recording from `first_ns` to `last_ns`, both included.

    All are on the grid of `step_ns`, except for the last one. The caller has to play to each time
    before it takes the next one. In silence there is a step just before the next message, since
    then all ages are highest.

    Args:
        player: of a bag, with the subscriptions that count as messages.
        first_ns, last_ns: the span.
        step_ns: between two times.
    """
    count = math.ceil((last_ns - first_ns) / step_ns - 1e-6)
    number = heard = 0
    while number < count:
        at_ns = first_ns + round(number * step_ns)
        is_silent = player.next_ns > at_ns
        yield at_ns
        heard = heard if is_silent else number
        until_next = math.ceil((player.next_ns - first_ns) / step_ns) - 1 - number
        longest = (number - heard - EVEN_STEPS) // GROWTH
        number += max(1, min(longest, until_next))
    yield last_ns
