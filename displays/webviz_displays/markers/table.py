"""A table of markers, whose columns are arrays."""

from __future__ import annotations

import heapq
from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from webviz.data.messages.markers import NOTHING, Content
from webviz_displays.markers.actions import Key
from webviz_displays.markers.batch import MarkerBatch

FOREVER = np.iinfo(np.int64).max
"""Time when markers without a lifetime expire."""

_LOOK = [
    ("type", np.int32),
    ("position", np.float64, 3),
    ("wxyz", np.float64, 4),
    ("scale", np.float64, 3),
    ("color", np.float32, 4),
    ("own_materials", np.bool_),
    ("locked", np.bool_),
]
_TIMES = [("stamp_ns", np.int64), ("expires_ns", np.int64), ("received_ns", np.int64)]
LOOK: np.dtype[np.void] = np.dtype(_LOOK, align=True)
"""Appearance of a marker, apart from its content."""
LOOK_NAMES = tuple(name for name, *_ in _LOOK)
_FIRST = 64
_COLUMNS = (
    *("wanted", "shown", "is_shown", "counts", "serials", "versions", "shown_versions"),
    *("first_ns", "_namespace_of"),
)


Place = tuple[str, int]
"""A frame and a stamp."""


class Table:
    """Rows of markers; those that are freed are used again, the lowest first.

    Attributes:
        namespaces: how many markers each has.
        wanted: the newest version of each marker, in its frame.
        shown: the version that is drawn, in the fixed frame; of a locked marker, in its frame.
        wanted_contents, shown_contents: the fields whose size varies.
        frames, shown_frames: of the newest version, and of the one that is drawn.
        keys: None for a row that is free.
        is_shown: whether `shown` is valid, which it is not in a free row.
        counts: how many points are drawn of each marker.
        serials: a number that no other marker has, (ns, id) of two lives included.
        versions, shown_versions: numbers of the newest version and of the one that is drawn; a
            later version has a higher number, 0 is none.
        first_ns: when the first version was received.
        changes: how often a marker came or went.
    """

    def __init__(self) -> None:
        self.rows: dict[Key, int] = {}
        self.namespaces: Counter[str] = Counter()
        self.keys: list[Key | None] = []
        self.frames: list[str] = []
        self.shown_frames: list[str] = []
        self.wanted_contents: list[Content] = []
        self.shown_contents: list[Content] = []
        self.wanted: NDArray[Any] = np.zeros(_FIRST, np.dtype(_LOOK + _TIMES, align=True))
        self.shown: NDArray[Any] = np.zeros(_FIRST, LOOK)
        self.is_shown = np.zeros(_FIRST, np.bool_)
        self.counts = np.zeros(_FIRST, np.intp)
        self.serials = np.zeros(_FIRST, np.int64)
        self.versions = np.zeros(_FIRST, np.int64)
        self.shown_versions = np.zeros(_FIRST, np.int64)
        self.first_ns = np.zeros(_FIRST, np.int64)
        self.changes = 0
        self.wanted["expires_ns"] = FOREVER
        self._namespace_of = np.full(_FIRST, -1)
        self._numbers: dict[str, int] = {}
        self._free: list[int] = []
        self._serial = 0

    def __len__(self) -> int:
        return len(self.rows)

    def row_of(self, key: Key) -> int:
        """Return the row of a marker, a new one if it is new."""
        row = self.rows.get(key)
        if row is not None:
            return row
        row = heapq.heappop(self._free) if self._free else len(self.keys)
        if row == len(self.keys):
            self.keys.append(key)
            self.frames.append("")
            self.shown_frames.append("")
            self.wanted_contents.append(NOTHING)
            self.shown_contents.append(NOTHING)
            if row == len(self.wanted):
                self._grow()
        self._serial += 1
        self.serials[row] = self._serial
        self.rows[key], self.keys[row] = row, key
        self.namespaces[key[0]] += 1
        self._namespace_of[row] = self._numbers.setdefault(key[0], self._serial)
        self.is_shown[row] = False
        self.versions[row] = self.shown_versions[row] = 0
        self.wanted["expires_ns"][row] = FOREVER
        self.changes += 1
        return row

    def remove(self, key: Key) -> int:
        """Free the row of a marker."""
        row = self.rows.pop(key)
        self.keys[row] = None
        self.namespaces[key[0]] -= 1
        if not self.namespaces[key[0]]:
            del self.namespaces[key[0]], self._numbers[key[0]]
        self._namespace_of[row] = -1
        self.is_shown[row] = False
        self.versions[row] = 0
        self.changes += 1
        self.wanted["expires_ns"][row] = FOREVER
        self.wanted_contents[row] = NOTHING
        self.show_content(row, NOTHING)
        heapq.heappush(self._free, row)
        return row

    def show_content(self, row: int, content: Content) -> None:
        """Draw other points, texts and files of a marker."""
        self.shown_contents[row], self.counts[row] = content, len(content.points)

    def in_namespaces(self, names: Iterable[str]) -> NDArray[np.bool_]:
        """Return the mask of rows with a marker of these namespaces."""
        numbers = [number for name in names if (number := self._numbers.get(name)) is not None]
        return np.isin(self._namespace_of, numbers)

    def batch(self, rows: NDArray[np.intp], origin: tuple[float, float, float]) -> MarkerBatch:
        """Return the markers in some rows as they are drawn, relative to an origin."""
        some = self.shown[rows]
        return MarkerBatch(
            some["type"],
            some["position"] - origin,
            some["wxyz"],
            some["scale"],
            some["color"],
            some["own_materials"],
            [self.shown_contents[row] for row in rows.tolist()],
            self.counts[rows],
            self.serials[rows],
        )

    def _grow(self) -> None:
        size = 2 * len(self.wanted)
        for name in _COLUMNS:
            old = getattr(self, name)
            new = np.zeros(size, old.dtype)
            new[: len(old)] = old
            setattr(self, name, new)
        self.wanted["expires_ns"][size // 2 :] = FOREVER
        self._namespace_of[size // 2 :] = -1


def by_place(table: Table, rows: Sequence[int]) -> dict[Place, list[int]]:
    """Return rows by what the pose of their newest versions depends on; locked ones need none."""
    frames, some = table.frames, table.wanted[np.array(rows, np.intp)]
    rows_by_place: dict[Place, list[int]] = {}
    stamps, names = some["stamp_ns"], {frames[row] for row in rows}
    if len(names) == 1 and not some["locked"].any() and (stamps == stamps[0]).all():
        return {(names.pop(), int(stamps[0])): list(rows)}  # as most arrays have them
    each = zip(rows, some["locked"].tolist(), some["stamp_ns"].tolist(), strict=True)
    for row, is_locked, stamp_ns in each:
        place = ("", 0) if is_locked else (frames[row], stamp_ns)
        rows_by_place.setdefault(place, []).append(row)
    return rows_by_place
