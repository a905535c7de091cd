"""Moments of a recording at which displays began to warn."""

from __future__ import annotations

from collections.abc import Sequence

from webviz.api.status import Level
from webviz.engine.state import Row
from webviz.sources.past_state import Event

MAX_EVENTS = 500
SECOND_NS = 1_000_000_000


class DisplayEvents:
    """Notes when the worst level of a display rises, as far as the recording was shown.

    A display is noted once per sentence and second of the recording, and forgotten when it is
    removed. The oldest notes give way to new ones.
    """

    def __init__(self) -> None:
        self._levels: dict[str, Level] = {}
        self._noted: dict[tuple[str, str, int], Event] = {}
        self.events: Sequence[Event] = ()
        """All notes by time; the same sequence until something changes."""

    def note(self, at_ns: int, rows: Sequence[Row]) -> None:
        """Compare displays with the last call.

        Args:
            at_ns: position in the recording.
            rows: all displays; groups are ignored, since they repeat what is in them.
        """
        rows = [row for row in rows if row.type != "Group"]
        before, self._levels = self._levels, {row.id: row.level for row in rows}
        noted = {key: event for key, event in self._noted.items() if key[0] in self._levels}
        for row in rows:
            level = row.level
            # A problem from the beginning is of the config, not of a moment of the recording.
            if level < Level.WARN or level <= before.get(row.id, level):
                continue
            text = next(status.text for status in row.statuses.values() if status.level == level)
            event = Event(at_ns, level, row.name, text)
            noted.setdefault((row.id, text, at_ns // SECOND_NS), event)
        if noted.keys() != self._noted.keys():
            self._noted = dict(list(noted.items())[-MAX_EVENTS:])
            self.events = tuple(sorted(self._noted.values(), key=lambda event: event.at_ns))
