"""What could not be carried over, and how much could."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field

NAMED = 4
"""Places that are named in a sentence; the rest is counted."""


@dataclass(frozen=True)
class Note:
    """Something in a file that is not shown as the file says.

    Args:
        place: a display, "Tools", "Panels" and so on.
        what: a property, a class.
        reason: why, and what happens instead.
    """

    place: str
    what: str
    reason: str


@dataclass
class Report:
    """Notes, and how many things of each kind there were and were carried over."""

    notes: list[Note] = field(default_factory=list)
    total: Counter[str] = field(default_factory=Counter)
    carried: Counter[str] = field(default_factory=Counter)

    def note(self, place: str, what: str, reason: str) -> None:
        """Tell of something that is not carried over as it is."""
        self.notes.append(Note(place, what, reason))

    def count(self, kind: str, carried: int, total: int) -> None:
        """Count things of a kind."""
        self.carried[kind] += carried
        self.total[kind] += total

    def sentences(self) -> list[str]:
        """The notes as sentences; what is said of several places is said once."""
        return sentences(self.notes)

    def table(self) -> str:
        """How many things of each kind were carried over, a line each."""
        lines = [
            f"{kind:12} {self.carried[kind]:4} of {total:4}  {percent(self.carried[kind], total)}"
            for kind, total in self.total.items()
        ]
        return "\n".join(lines)


def sentences(notes: Sequence[Note]) -> list[str]:
    """Notes as sentences; what is said of several places or things is said once."""
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
    """Text of a file that does nothing to a terminal."""
    return "".join(letter if letter.isprintable() else " " for letter in text)


def _listed(places: list[str]) -> str:
    rest = len(places) - NAMED
    more = [f"{rest} more"] if rest > 0 else []
    return ", ".join([*places[:NAMED], *more])


def percent(part: int, whole: int) -> str:
    """A part as people say it."""
    return f"{100 * part / whole:3.0f} %" if whole else "-"
