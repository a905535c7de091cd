"""A report of what an import could not carry over, with counts."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import msgspec

NAMED = 4
"""Places listed in a sentence; the rest is counted."""


class Note(msgspec.Struct, frozen=True):
    """A part of a file that is not shown as written.

    Args:
        place: a display, "Tools", "Panels" and so on.
        what: a property, a class.
        reason: why, and what happens instead.
    """

    place: str
    what: str
    reason: str


class Report(msgspec.Struct):
    """Notes, and per kind the numbers of things found and carried over."""

    notes: list[Note] = msgspec.field(default_factory=list)
    total: Counter[str] = msgspec.field(default_factory=Counter)
    carried: Counter[str] = msgspec.field(default_factory=Counter)

    def note(self, place: str, what: str, reason: str) -> None:
        """Report something that is not carried over unchanged."""
        self.notes.append(Note(place, what, reason))

    def count(self, kind: str, carried: int, total: int) -> None:
        """Count things of a kind."""
        self.carried[kind] += carried
        self.total[kind] += total

    @property
    def is_complete(self) -> bool:
        """Return whether everything that was counted is carried over."""
        return not self.missing

    @property
    def missing(self) -> list[str]:
        """The kinds of which something is not carried over."""
        return [kind for kind, total in self.total.items() if self.carried[kind] < total]

    def sentences(self) -> list[str]:
        """Return the notes as sentences; a note on several places becomes one."""
        return sentences(self.notes)

    def table(self) -> str:
        """Return the number of things carried over, one line per kind."""
        lines = [
            f"{kind:12} {self.carried[kind]:4} of {total:4}  {percent(self.carried[kind], total)}"
            for kind, total in self.total.items()
        ]
        return "\n".join(lines)


def sentences(notes: Sequence[Note]) -> list[str]:
    """Return notes as sentences; equal notes on several places or things become one."""
    places: dict[tuple[str, str], list[str]] = {}
    for note in notes:
        where = places.setdefault((note.reason, note.what), [])
        if note.place not in where:
            where.append(note.place)
    things: dict[tuple[str, str], list[str]] = {}
    for (reason, what), where in places.items():
        things.setdefault((_listed(where), reason), []).append(what)
    return [
        _printable(f"{where}: {', '.join(what)}: {reason}.")
        for (where, reason), what in things.items()
    ]


def _printable(text: str) -> str:
    """Text of a file without terminal control characters."""
    return "".join(letter if letter.isprintable() else " " for letter in text)


def _listed(places: list[str]) -> str:
    rest = len(places) - NAMED
    more = [f"{rest} more"] if rest > 0 else []
    return ", ".join([*places[:NAMED], *more])


def percent(part: int, whole: int) -> str:
    """Return a percentage."""
    return f"{100 * part / whole:3.0f} %" if whole else "-"
