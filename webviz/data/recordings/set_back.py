"""A clock that was set back during a recording, so that later messages have earlier times."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

LEAST_NS = 2_000_000_000
"""Recorders mix messages of less than this, without a clock that is set."""


class SetBack(NamedTuple):
    """The times of recording between which messages are mixed: after the jump, and before it."""

    after_ns: int
    before_ns: int

    def note(self, name: str, start_ns: int) -> str:
        """Sentences on it, for the recording of a name that starts at a time."""
        first_s, last_s = ((each - start_ns) / 1e9 for each in self)
        return (
            f"The clock was set back by {last_s - first_s:.0f} s while {name} was recorded: from "
            f"{first_s:.1f} to {last_s:.1f} s, messages from before and after are interleaved. "
            "Select a span outside this range."
        )


def set_back_in(stamps_ns: npt.NDArray[np.uint64]) -> SetBack | None:
    """Return the largest jump back of times in the order of writing, None if there is none."""
    if len(stamps_ns) < 2:
        return None
    before = np.maximum.accumulate(stamps_ns)[:-1]
    jumps = before.astype(np.int64) - stamps_ns[1:].astype(np.int64)
    at = int(jumps.argmax())
    if jumps[at] < LEAST_NS:
        return None
    return SetBack(int(stamps_ns[at + 1]), int(before[at]))
