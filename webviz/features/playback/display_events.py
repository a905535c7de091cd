"""Moments of a recording at which displays began to warn."""

from __future__ import annotations

from collections.abc import Sequence

from webviz.api.status import LOADING, Level, Status, worst_status
from webviz.engine.state import Row
from webviz.sources.past_state import Event

MAX_EVENTS = 500
SECOND_NS = 1_000_000_000


class DisplayEvents:
    """Notes when the worst level of a display rises, as far as the recording was shown.

    Loading is not noted, as it ends by itself. A display is noted once per sentence and second of
    the recording, and forgotten when it is removed. The oldest notes give way to new ones.
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
        worst = {row.id: _worst(row) for row in rows}
        before, self._levels = self._levels, {id: status.level for id, status in worst.items()}
        noted = {key: event for key, event in self._noted.items() if key[0] in self._levels}
        for row in rows:
            status = worst[row.id]
            # A problem from the beginning is of the config, not of a moment of the recording.
            if status.level < Level.WARN or status.level <= before.get(row.id, status.level):
                continue
            event = Event(at_ns, status.level, row.name, status.text)
            noted.setdefault((row.id, status.text, at_ns // SECOND_NS), event)
        if noted.keys() != self._noted.keys():
            self._noted = dict(list(noted.items())[-MAX_EVENTS:])
            self.events = tuple(sorted(self._noted.values(), key=lambda event: event.at_ns))


def _worst(row: Row) -> Status:
    return worst_status(status for key, status in row.statuses.items() if key != LOADING)
