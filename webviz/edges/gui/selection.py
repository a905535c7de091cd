"""Which display the panel is about."""

from __future__ import annotations

from collections.abc import Sequence

from webviz.edges.gui.moves import Moves, Place, moves_of
from webviz.engine.state import Row


class Selection:
    """The selected display: a new one somebody added, or the successor of a removed one.

    Any thread may read it, choose or expect; the frame loop alone follows.
    """

    def __init__(self) -> None:
        self.id: str | None = None
        self.row: Row | None = None
        self.moves = Moves()
        """Where it can go in the list."""
        self._places: tuple[Place, ...] = ()
        self._moved = ""
        self._expects_new = False

    def choose(self, id: str) -> None:
        """Select a display."""
        self.id = id

    def expect_new(self) -> None:
        """Select the next display that is added."""
        self._expects_new = True

    def follow(self, rows: Sequence[Row]) -> None:
        """Keep a display selected as the list changes."""
        places = tuple([Place(row.id, row.depth, row.type) for row in rows])
        if places != self._places:
            self._reselect(places)
        if places != self._places or self._moved != self.id:
            self._places, self._moved = places, self.id or ""
            self.moves = moves_of(self._moved, places)
        self.row = next((row for row in rows if row.id == self.id), None)

    def _reselect(self, places: tuple[Place, ...]) -> None:
        ids = [place.id for place in places]
        known = [place.id for place in self._places]
        new = [place for place in places if place.id not in known]
        if self._expects_new and new:
            # With a group comes what is in it.
            depth = min(place.depth for place in new)
            self.id = next(place.id for place in reversed(new) if place.depth == depth)
            self._expects_new = False
        elif self.id not in ids:
            index = known.index(self.id) if self.id in known else 0
            self.id = ids[min(index, len(ids) - 1)] if ids else None
