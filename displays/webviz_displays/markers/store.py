"""The newest version of each marker, and where it is drawn."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from webviz import Frames, Pose
from webviz.data.messages.markers import NOTHING, Content, MarkerSequence
from webviz.data.rotations import matrices, multiply_many, normalized, w_first
from webviz_displays.markers.actions import Key, effect_of
from webviz_displays.markers.contents import Memory, detached, is_same, size_of
from webviz_displays.markers.faults import is_valid
from webviz_displays.markers.older import OlderVersions, Versions
from webviz_displays.markers.remarks import REMEMBERED, DeletedMarker, Remarks
from webviz_displays.markers.table import FOREVER, LOOK, LOOK_NAMES, Place, Table, by_place

MAX_MARKERS = 100_000
"""Largest number of markers of a display; further ones are refused."""
MAX_BYTES = 256_000_000
"""Limit in bytes of the lists, texts and meshes of a display; markers beyond it are refused."""
MAX_TEXT = 10_000
"""Characters of one marker; browsers draw each of them as two triangles."""
AT_ONCE = 3000
"""Markers of a message that are taken in one turn of the frame loop; each takes 4 µs."""
SHORTEST_NS = 100_000
"""Lifetimes up to this mean for ever, as in RViz."""
MAX_LOOKUPS = 1000
"""Frames and stamps that are looked up in one turn of the frame loop."""
TILTED = 1e-3
"""Tolerance of the length of a quaternion around 1."""


class Store:
    """All markers of a display.

    A new version waits for its transform while the former one stays, and so do versions that come
    meanwhile: the newest one that has a transform is drawn. What is deleted goes at once.
    """

    def __init__(self) -> None:
        self.table = Table()
        self.version = 0
        """Changes whenever something else is to be drawn or said."""
        self.changed: set[int] = set()
        """Rows to be drawn anew, until they are."""
        self.waiting: dict[Place, list[int]] = {}
        """Rows whose newest version has no pose yet."""
        self._has_removed = False
        """True if some of them may be free."""
        self._older = OlderVersions()
        self._number = 0
        """Number of the last versions."""
        self.remarks = Remarks()
        self._steps: Iterator[None] = iter(())
        self.is_unfinished = False
        """True while a message is taken only in part; nothing of it is to be drawn yet."""
        self._todo: set[int] = set()
        self._tried = -1
        self._memory = Memory(MAX_BYTES)
        self._next_expiry = FOREVER
        self._fixed_frame = ""

    # Messages

    def apply(self, markers: MarkerSequence, received_ns: int, is_array: bool = True) -> None:
        """Take the markers of one message; `advance` takes very many.

        Args:
            markers: in order.
            received_ns: ROS time of arrival, from which lifetimes count.
            is_array: whether they came in one array, in which none may be there twice.
        """
        while self.is_unfinished:
            self.advance()
        self._steps = self._applied(markers, received_ns, is_array)
        self.is_unfinished = True
        if len(markers) <= AT_ONCE:
            self.advance()

    @property
    def waiting_count(self) -> int:
        """Return how many markers wait for a transform."""
        return sum(map(len, self.waiting.values()))

    def waiting_since_ns(self) -> NDArray[np.int64]:
        """Return when the oldest version was received that is not drawn yet, of rows that wait."""
        table = self.table
        since_ns = table.wanted["received_ns"].copy()
        for versions in self._older.undrawn(table):
            np.minimum.at(since_ns, versions.rows, versions.look["received_ns"])
        return np.where(table.is_shown, since_ns, table.first_ns)

    def advance(self) -> None:
        """Take the next markers of the last message."""
        if self.is_unfinished:
            self.is_unfinished = next(self._steps, self) is None

    def _applied(self, markers: MarkerSequence, received_ns: int, is_array: bool) -> Iterator[None]:
        """Take the markers of one message in steps."""
        self.expire(received_ns)
        effect = effect_of(markers)
        doomed = effect.doomed(self.table.rows)
        for start in range(0, len(doomed), AT_ONCE):
            if start:
                yield
            for key in doomed[start : start + AT_ONCE]:
                self._remove(key, "Deleted", received_ns)
        remarks = self.remarks
        for key in effect.doomed(remarks.refused):
            del remarks.refused[key]
        numbers = np.array([i for same in effect.added.values() for i in same.values()], np.intp)
        ok = is_valid(markers)
        for start in range(0, len(numbers), AT_ONCE):
            if start:
                yield
            self._put(markers, numbers[start : start + AT_ONCE], ok, received_ns)
        if max(len(doomed), len(numbers)) > AT_ONCE:
            yield  # drawing takes a turn of its own
        if is_array:
            remarks.duplicates = effect.duplicates[:REMEMBERED]
        if effect.unknown:
            remarks.unknown_actions = effect.unknown[:REMEMBERED]
        self.version += 1

    def expire(self, now_ns: int) -> None:
        """Remove the markers whose lifetime has ended."""
        if now_ns < self._next_expiry:
            return
        table = self.table
        expires = table.wanted["expires_ns"]
        for row in np.flatnonzero(expires <= now_ns).tolist():
            if key := table.keys[row]:
                self._remove(key, "Expired", int(expires[row]))
        self._next_expiry = int(table.wanted["expires_ns"].min())
        self.version += 1

    def _put(
        self,
        markers: MarkerSequence,
        numbers: NDArray[np.intp],
        ok: NDArray[np.bool_],
        received_ns: int,
    ) -> None:
        """Add markers of these numbers, or new versions of them, as far as they are `ok`."""
        table, wanted_contents = self.table, self.table.wanted_contents
        numbered = numbers.tolist()
        namespaces = [markers.namespaces[i] for i in numbered]
        keys = list(zip(namespaces, markers.ids[numbers].tolist(), strict=True))
        contents = [markers.contents[i] for i in numbered]
        rows_before = [table.rows.get(key) for key in keys]
        self._older.keep(table, np.array([row for row in rows_before if row is not None], np.intp))
        each = zip(rows_before, contents, ok[numbers].tolist(), strict=True)
        # Most are there, with what they have; a step each in the interpreter is most of the time.
        is_easy = [
            row is not None and content is wanted_contents[row] and is_ok
            for row, content, is_ok in each
        ]
        for place in [place for place, easy in enumerate(is_easy) if not easy]:
            i = numbered[place]
            rows_before[place] = self._row_for(
                keys[place], contents[place], bool(ok[i]), received_ns
            )
        rows = [row for row in rows_before if row is not None]
        free_rows = [i for i, row in zip(numbered, rows_before, strict=True) if row is not None]
        if not rows:
            return
        new = self._looks(markers, np.array(free_rows), received_ns)
        where = _span(np.array(rows))
        is_new = ~table.is_shown[where] | _is_other(new, table.wanted[where])
        is_new |= new["stamp_ns"] != table.wanted["stamp_ns"][where]
        is_first = table.versions[where] == 0
        table.first_ns[where] = np.where(is_first, received_ns, table.first_ns[where])
        table.wanted[where] = new
        self._next_expiry = min(self._next_expiry, int(new["expires_ns"].min()))
        self._todo.update(itertools.compress(rows, is_new.tolist()))
        frames, wanted_contents, are_shown = (
            table.frames,
            table.wanted_contents,
            table.shown_contents,
        )
        named = {frame: frame.removeprefix("/") for frame in set(markers.frame_ids)}
        contents_given = [named[markers.frame_ids[i]] for i in free_rows]
        for row, frame in zip(rows, contents_given, strict=True):
            if frame != frames[row] or wanted_contents[row] is not are_shown[row]:
                frames[row] = frame
                self._todo.add(row)
        self._number += 1
        table.versions[[row for row in rows if row in self._todo]] = self._number
        self.remarks.accept(table.keys[row] for row in rows)

    def _row_for(self, key: Key, content: Content, is_ok: bool, received_ns: int) -> int | None:
        """Return the row of a marker, which keeps its content; None if that is refused."""
        table, remarks = self.table, self.remarks
        if not is_ok:
            remarks.refuse(key, "It has a number that is not finite, or more than 1e9 m.")
            return None
        if content is not NOTHING and (length := len(content.text)) > MAX_TEXT:
            why = f"Its text has {length} characters; the limit is {MAX_TEXT}."
            remarks.refuse(key, why)
            return None
        row = table.rows.get(key)
        if row is None:
            if len(table) >= MAX_MARKERS:
                remarks.overflow += 1
                return None
            row = table.row_of(key)
        if not self._put_content(row, content):
            remarks.refuse(key, "The markers of this display exceed 256 MB.")
            if not table.is_shown[row]:
                self._remove(key, "Deleted", received_ns)
            return None
        return row

    def _looks(
        self, markers: MarkerSequence, numbers: NDArray[np.intp], received_ns: int
    ) -> NDArray[Any]:
        new = np.zeros(len(numbers), self.table.wanted.dtype)
        of = _span(numbers)
        xyzw = markers.orientations[of]
        wxyz, _ = normalized(w_first(xyzw))
        with np.errstate(over="ignore"):
            is_tilted = np.abs(np.linalg.norm(xyzw, axis=1) - 1.0) > TILTED
        tilted = self.remarks.tilted
        if is_tilted.any() or tilted:
            for i, is_so in zip(numbers.tolist(), is_tilted.tolist(), strict=True):
                key = markers.namespaces[i], int(markers.ids[i])
                (tilted.add if is_so else tilted.discard)(key)
        new["type"], new["locked"] = markers.types[of], markers.frame_locked[of]
        new["position"], new["wxyz"] = markers.positions[of], wxyz
        new["scale"], new["color"] = markers.scales[of], markers.colors[of]
        new["own_materials"] = markers.own_materials[of]
        new["stamp_ns"], new["received_ns"] = markers.stamps_ns[of], received_ns
        lifetimes = markers.lifetimes_ns[of]
        ends = np.minimum(lifetimes, FOREVER - received_ns) + received_ns
        new["expires_ns"] = np.where(lifetimes > SHORTEST_NS, ends, FOREVER)
        return new

    def _put_content(self, row: int, content: Content) -> bool:
        """Keep the content of a version, the former if they are equal; whether there is room."""
        if is_same(content, self.table.wanted_contents[row]):
            return True
        if not self._memory.take(row, size_of(content)):
            return False
        self.table.wanted_contents[row] = detached(content)
        return True

    def _remove(self, key: Key, how: str, at_ns: int) -> None:
        row = self.table.rows[key]
        was_shown, serial = self.table.is_shown[row], int(self.table.serials[row])
        self.table.remove(key)
        self.remarks.go(serial, DeletedMarker(key, how, at_ns))
        self._memory.free(row)
        self._todo.discard(row)
        self._has_removed = True
        self.remarks.tilted.discard(key)
        if was_shown:
            self.changed.add(row)

    # Transforms

    def place(self, frames: Frames) -> None:
        """Draw the newest versions of all markers that have a pose."""
        if frames.fixed_frame != self._fixed_frame:
            self._move(frames)
        if self._has_removed:
            self._has_removed = False
            keys = self.table.keys
            left = {
                place: [row for row in rows if keys[row] is not None]
                for place, rows in self.waiting.items()
            }
            self.waiting = {place: rows for place, rows in left.items() if rows}
        is_new = frames.buffer.version != self._tried
        if self._todo:
            self._settle(frames)
        elif self.waiting and is_new:
            tried = list(itertools.islice(self.waiting, MAX_LOOKUPS))
            for place in tried:
                rows = self.waiting.pop(place)
                if (pose := _pose(place, frames)) is None:
                    self.waiting[place] = rows  # the others come first in the next turn
                else:
                    self._show(np.array(rows), pose)
        if self._older and is_new:
            self._show_older(frames)
        self._tried = frames.buffer.version

    def _show_older(self, frames: Frames) -> None:
        """Draw the newest versions with a pose of markers whose newest version has none."""
        for versions in self._older.undrawn(self.table):
            if (pose := _pose(versions.place, frames)) is not None:
                self._show(versions.rows, pose, versions)

    def _settle(self, frames: Frames) -> None:
        """Draw what is new, if it has a pose."""
        late = {row for rows in self.waiting.values() for row in rows}
        self.waiting = {}
        rows = [row for row in late | self._todo if self.table.keys[row] is not None]
        self._todo.clear()
        for number, (place, some) in enumerate(by_place(self.table, rows).items()):
            pose = _pose(place, frames) if number < MAX_LOOKUPS else None
            if pose is None:
                self.waiting[place] = some
            else:
                self._show(np.array(some), pose)
        self.version += 1

    def _show(self, rows: NDArray[np.intp], pose: Pose, older: Versions | None = None) -> None:
        """Draw versions of some markers, whose frame has this pose: the newest, or older ones."""
        table = self.table
        where = _span(rows)
        new = table.wanted[where] if older is None else older.look
        look = np.zeros(len(rows), LOOK)
        for name in LOOK_NAMES:
            look[name] = new[name]
        look["position"], look["wxyz"] = _moved(new["position"], new["wxyz"], pose)
        changed = ~table.is_shown[where] | _is_other(look, table.shown[where])
        table.shown[where], table.is_shown[where] = look, True
        table.shown_versions[where] = table.versions[where] if older is None else older.numbers
        self.changed.update(rows[changed].tolist())
        is_locked = bool(new["locked"].any())
        shown_frames, shown_contents = table.shown_frames, table.shown_contents
        numbers = rows.tolist()
        frames = [table.frames[row] for row in numbers] if older is None else older.frames
        contents = (
            [table.wanted_contents[row] for row in numbers] if older is None else older.contents
        )
        for row, frame, content in zip(numbers, frames, contents, strict=True):
            if frame != shown_frames[row]:
                shown_frames[row] = frame
                if is_locked:
                    self.changed.add(row)
            if content is not shown_contents[row]:
                table.show_content(row, content)
                self.changed.add(row)
        self.version += 1

    def _move(self, frames: Frames) -> None:
        """Place all markers in another fixed frame.

        Each at its own stamp; those older than the transforms move with the former fixed frame.
        """
        former, self._fixed_frame = self._fixed_frame, frames.fixed_frame
        table = self.table
        shown_rows = [row for row in table.rows.values() if table.is_shown[row]]
        if not shown_rows:
            return
        shift = frames.latest(former)
        loose = [row for row in shown_rows if not table.shown["locked"][row]]
        for place, rows in by_place(table, loose).items():
            if _pose(place, frames) is not None:
                self._todo.update(rows)
            elif shift is not None:
                each = np.array(rows)
                some = table.shown[each]
                table.shown["position"][each], table.shown["wxyz"][each] = _moved(
                    some["position"], some["wxyz"], shift
                )
            else:
                table.is_shown[rows] = False
                self._todo.update(rows)
        self.changed.update(loose)
        self.version += 1


def _span(rows: NDArray[np.intp]) -> slice | NDArray[np.intp]:
    """Return consecutive rows as a slice, through which numpy reads without a copy."""
    first, last = int(rows[0]), int(rows[-1])
    is_span = last - first == len(rows) - 1 and bool((np.diff(rows) == 1).all())
    return slice(first, last + 1) if is_span else rows


def _is_other(new: NDArray[Any], old: NDArray[Any]) -> NDArray[np.bool_]:
    """Return which looks (N,) differ."""
    is_different = np.zeros(len(new), np.bool_)
    for name in LOOK_NAMES:
        differs = new[name] != old[name]
        is_different |= differs if differs.ndim == 1 else differs.any(axis=1)
    return is_different


def _pose(place: Place, frames: Frames) -> Pose | None:
    frame, stamp_ns = place
    return Pose() if frame in ("", frames.fixed_frame) else frames.at(frame, stamp_ns)


def _moved(
    positions: NDArray[np.float64], wxyzs: NDArray[np.float64], pose: Pose
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Poses moved from the frame that has a pose."""
    if pose == Pose():
        return positions, wxyzs
    turned = np.einsum("ij,nj->ni", matrices(pose.wxyz), positions)
    return turned + pose.position, multiply_many(pose.wxyz, wxyzs)
