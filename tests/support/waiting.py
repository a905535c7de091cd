"""Waiting for a state, however long a busy machine takes."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TypeVar

T = TypeVar("T")

PATIENCE_S = 60.0
LOOK_S = 0.005
"""Pause in seconds between two looks at what costs nothing to look at."""


def until(
    condition: Callable[[], T | None],
    lacking: Callable[[], object] = lambda: "It does not happen.",
    *,
    turn: Callable[[], object] = lambda: None,
    seconds: float = PATIENCE_S,
    look_s: float = LOOK_S,
) -> T:
    """Wait until a condition holds, and return what it returns.

    Args:
        condition: looked at again and again.
        lacking: returns what to report if it does not hold in time.
        turn: called in between, such as a turn of a loop.
        seconds: to wait at most.
        look_s: between two looks, longer where each takes much of a processor.
    """
    deadline = time.monotonic() + seconds
    while not (result := condition()):
        assert time.monotonic() < deadline, lacking()
        turn()
        time.sleep(look_s)
    return result
