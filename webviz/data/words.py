"""Counts, lists, problems and joins of sentences, and entered numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

ENDS = ".!?:…"
"""Characters that end a sentence; a list follows the colon."""


class Problem(NamedTuple):
    """A cause and its remedy, one sentence each."""

    cause: str
    remedy: str

    def __str__(self) -> str:
        return joined(self.cause, self.remedy)


def counted(number: int, noun: str) -> str:
    """Return a count with its noun, such as "2 links"."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def number_in(text: str) -> float | None:
    """Return the finite number that a text is, None if it is something else."""
    try:
        number = float(text)
    except ValueError:
        return None
    return number if math.isfinite(number) else None


def spaced(count: int) -> str:
    """Return a number with spaces between thousands."""
    return f"{count:,}".replace(",", " ")


def listed(names: Sequence[str], most: int) -> str:
    """Return the first names, each once, and how many more there are: "a, b and 3 more"."""
    names = [*dict.fromkeys(names)]
    rest = len(names) - most
    return ", ".join(names[:most]) + (f" and {rest} more" if rest > 0 else "")


def joined(*texts: str) -> str:
    """Sentences after each other; one that does not end gets a full stop, empty ones are dropped.

    For texts of which one comes from elsewhere, such as an exception or another machine.
    """
    stripped = (text.strip() for text in texts)
    return " ".join(text if text[-1] in ENDS else f"{text}." for text in stripped if text)


def shortened(text: str, most: int) -> str:
    """Return a text of at most `most` characters; "…" ends one that was longer."""
    return text if len(text) <= most else f"{text[: most - 1]}…"


def plain(text: str, most: int) -> str:
    """Return a text from elsewhere in one line of printable characters, at most `most` of them."""
    line = " ".join(text[: 4 * most].split())
    return shortened("".join(c if c.isprintable() else "?" for c in line), most)
