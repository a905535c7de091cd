"""Versions of markers that wait for their transforms while newer ones wait, too."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz.data.messages.markers import Content
from webviz_displays.markers.contents import size_of
from webviz_displays.markers.table import Place, Table, by_place

MAX_GROUPS = 1000
"""Groups of versions with one frame and stamp, each of which is looked up on every turn."""
MAX_VERSIONS = 100_000
"""Largest number of versions of all markers of a display; the oldest go first."""
MAX_BYTES = 64_000_000
"""Limit in bytes of their lists, texts and meshes."""


class Versions(msgspec.Struct, frozen=True):
    """Versions of different markers with one frame and stamp.

    Args:
        place: frame and stamp.
        rows: intp (N,), of the table.
        serials, numbers: int64 (N,), of the markers and of these versions.
        look: (N,), as the table has it.
        frames: N frame ids.
        contents: N contents.
        size: bytes of the contents.
    """

    place: Place
    rows: NDArray[np.intp]
    serials: NDArray[np.int64]
    numbers: NDArray[np.int64]
    look: NDArray[Any]
    frames: Sequence[str]
    contents: Sequence[Content]
    size: int = 0

    @classmethod
    def of(cls, table: Table, place: Place, rows: NDArray[np.intp]) -> Versions:
        """Return the newest versions of markers."""
        numbers, contents = rows.tolist(), table.wanted_contents
        chosen = [contents[row] for row in numbers]
        return cls(
            place,
            rows,
            table.serials[rows],
            table.versions[rows],
            table.wanted[rows],
            [table.frames[row] for row in numbers],
            chosen,
            sum(map(size_of, chosen)),
        )

    def undrawn(self, table: Table) -> Versions | None:
        """Return those that are newer than what is drawn of their markers, None without any."""
        rows = self.rows
        is_alive = (table.serials[rows] == self.serials) & (table.versions[rows] > 0)
        is_alive &= self.numbers > table.shown_versions[rows]
        if is_alive.all():
            return self
        places = np.flatnonzero(is_alive).tolist()
        if not places:
            return None
        return Versions(
            self.place,
            rows[is_alive],
            self.serials[is_alive],
            self.numbers[is_alive],
            self.look[is_alive],
            [self.frames[place] for place in places],
            [self.contents[place] for place in places],
        )


class OlderVersions:
    """Keeps versions that a newer one replaced before they had a pose.

    Without them, what is drawn of a marker that is sent more often than transforms come would
    depend on how often one looks, and on where playing began.
    """

    def __init__(self) -> None:
        self._groups: dict[tuple[Place, bytes], Versions] = {}
        """Rows by frame and stamp; oldest first."""
        self._count = self._bytes = 0

    def __bool__(self) -> bool:
        return bool(self._groups)

    def keep(self, table: Table, rows: NDArray[np.intp]) -> None:
        """Keep the newest versions of some markers, as far as they are not drawn.

        Args:
            table: of all markers, which is about to be changed.
            rows: intp (N,), of the table.
        """
        rows = rows[table.versions[rows] > table.shown_versions[rows]]
        if not len(rows):
            return
        for place, some in by_place(table, rows.tolist()).items():
            versions = Versions.of(table, place, np.array(some, np.intp))
            key = place, versions.rows.tobytes()
            if (before := self._groups.get(key)) is not None:
                # They have the same pose, or none either.
                is_same = before.serials == versions.serials
                times_ns = versions.look["received_ns"]
                times_ns[is_same] = before.look["received_ns"][is_same]
                self._drop(key)
            self._groups[key] = versions
            self._count, self._bytes = self._count + len(some), self._bytes + versions.size
        while self._groups and (
            len(self._groups) > MAX_GROUPS or self._count > MAX_VERSIONS or self._bytes > MAX_BYTES
        ):
            self._drop(next(iter(self._groups)))

    def undrawn(self, table: Table) -> Iterator[Versions]:
        """Yield those that are newer than what is drawn of their markers; others are forgotten."""
        for key, versions in list(self._groups.items()):
            if (some := versions.undrawn(table)) is None:
                self._drop(key)
            else:
                yield some

    def _drop(self, key: tuple[Place, bytes]) -> None:
        versions = self._groups.pop(key, None)
        if versions is not None:
            self._count, self._bytes = self._count - len(versions.rows), self._bytes - versions.size
