"""Nodes of markers by blocks of rows: a marker that changes renews the nodes of its block only."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Set

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz import Context, Group, Level, Node, Pose
from webviz_displays.markers.assets import Assets
from webviz_displays.markers.faults import faults_of
from webviz_displays.markers.nodes import nodes_of
from webviz_displays.markers.table import Table
from webviz_urdf import LoadRequest

BLOCK = 1024
"""Rows per block."""
LARGE = 2000
"""Points above which a marker is a block of its own."""
MAX_PLACES = 500
"""Groups of a display: each frame that markers are locked to, and each cell."""
CELL_M = 4000.0
"""Nodes are float32, which resolves 0.1 mm at half this distance from their origin."""

Place = tuple[str, tuple[float, float, float]]
"""The frame that a group follows, "" for the fixed frame, and its origin there."""


class Block(msgspec.Struct, frozen=True, eq=False):
    """The nodes of some rows.

    Args:
        nodes: by where their group is, and by key.
        faults: sentences about markers that cannot be seen, by row.
        count: how many markers are drawn.
        requests: the files that they name.
        left_out: how many markers are in places beyond `MAX_PLACES`.
    """

    nodes: Mapping[Place, Mapping[str, Node]] = msgspec.field(default_factory=dict)
    faults: Mapping[int, tuple[Level, str]] = msgspec.field(default_factory=dict)
    count: int = 0
    requests: Set[LoadRequest] = frozenset()
    left_out: int = 0


class Blocks:
    """The nodes of all markers."""

    def __init__(self) -> None:
        self._blocks: dict[int, Block] = {}
        self._large: set[int] = set()

    def __iter__(self) -> Iterator[Block]:
        return iter(self._blocks.values())

    def clear(self) -> None:
        """Make all nodes anew next time."""
        self._blocks.clear()
        self._large.clear()

    def requests(self) -> set[LoadRequest]:
        """Return the files that markers name."""
        return {request for block in self for request in block.requests}

    def renew(
        self,
        table: Table,
        changed: Iterable[int],
        arrived: Set[LoadRequest],
        off: Set[str],
        assets: Assets,
    ) -> None:
        """Make the nodes of the blocks that have a changed row.

        Args:
            table: of the markers.
            changed: rows.
            arrived: files that have been loaded.
            off: namespaces whose markers are not drawn.
            assets: the files that they name.
        """
        rows = set(changed)
        if not self._blocks:
            rows |= set(table.rows.values())
        is_drawn = table.is_shown & ~table.in_namespaces(off) if off else table.is_shown
        dirty = {n for n, block in self._blocks.items() if not arrived.isdisjoint(block.requests)}
        each = np.array(list(rows), np.intp)
        large = set(each[table.counts[each] > LARGE].tolist())
        were_large = self._large & rows
        self._large = (self._large - were_large) | large
        dirty.update(-1 - row for row in large | were_large)
        dirty.update((np.array(list(rows - (large & were_large)), np.intp) // BLOCK).tolist())
        clean = [block for number, block in self._blocks.items() if number not in dirty]
        places = {place for block in clean for place in block.nodes}
        if len(places) < MAX_PLACES:
            dirty.update(number for number, block in self._blocks.items() if block.left_out)
        for number in dirty:
            block = self._make(number, table, is_drawn, assets, places)
            if block is None:
                self._blocks.pop(number, None)
            else:
                self._blocks[number] = block

    def draw(self, ctx: Context) -> None:
        """Add the nodes to a context."""
        groups: dict[Place, Group] = {}
        for number, block in self._blocks.items():
            for place, nodes in block.nodes.items():
                if place not in groups:
                    frame, origin = place
                    key = ",".join(f"{metres:g}" for metres in origin)
                    groups[place] = ctx.follow(frame or None, offset=Pose(origin), key=key)
                for name, node in nodes.items():
                    groups[place].add(f"{name} in {number}", node)

    def _make(
        self,
        number: int,
        table: Table,
        is_drawn: NDArray[np.bool_],
        assets: Assets,
        places: set[Place],
    ) -> Block | None:
        if number < 0:
            rows = np.array([-1 - number] if -1 - number in self._large else [], np.intp)
        else:
            rows = np.arange(number * BLOCK, min((number + 1) * BLOCK, len(table.keys)))
            rows = rows[table.counts[rows] <= LARGE]
        drawn_rows = rows[is_drawn[rows]]
        if not len(drawn_rows):
            return None
        nodes: dict[Place, Mapping[str, Node]] = {}
        faults: dict[int, tuple[Level, str]] = {}
        requests: set[LoadRequest] = set()
        left_out = 0
        for place, some in _by_group(table, drawn_rows):
            if place not in places and len(places) >= MAX_PLACES:
                left_out += len(some)
                continue
            places.add(place)
            batch = table.batch(some, place[1])
            files, missing, named = assets.of(batch)
            requests |= named
            block_nodes = nodes_of(batch, files)
            if block_nodes:
                nodes[place] = block_nodes
            for row, level, text in (*faults_of(batch), *missing):
                faults[int(some[row])] = level, text
        return Block(nodes, faults, len(drawn_rows) - len(faults) - left_out, requests, left_out)


def _by_group(table: Table, rows: NDArray[np.intp]) -> Iterator[tuple[Place, NDArray[np.intp]]]:
    """Rows by the group that their nodes are in."""
    some = table.shown[rows]
    cells = np.round(some["position"] / CELL_M) * CELL_M
    cells[some["locked"]] = 0.0
    locked = np.flatnonzero(some["locked"]).tolist()
    if not locked and (cells == cells[0]).all():
        yield ("", _origin(cells[0])), rows
        return
    frames = [""] * len(rows)
    for index in locked:
        frames[index] = table.shown_frames[int(rows[index])]
    by_group: dict[Place, list[int]] = {}
    for frame, cell, row in zip(frames, cells, rows.tolist(), strict=True):
        by_group.setdefault((frame, _origin(cell)), []).append(row)
    for place, group in by_group.items():
        yield place, np.array(group)


def _origin(cell: NDArray[np.float64]) -> tuple[float, float, float]:
    x, y, z = (cell + 0.0).tolist()  # -0.0 is 0
    return x, y, z
