"""Octrees of octomap_msgs/Octomap, read level by level instead of node by node.

A full tree is a record for each node, depth first: its log-odds (float32), its colour if it has
one (3 bytes), and a byte with a bit for each child. A binary tree has records of two bytes for
inner nodes only: two bits per child, 1 for a free leaf, 2 for an occupied one, 3 for a child with a
record of its own. Child i lies at +x if its bit 0 is set, at +y for bit 1, at +z for bit 2.
(OctoMap 1.10, OcTreeBaseImpl::writeNodesRecurs and OccupancyOcTreeBase::writeBinaryNode.)
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz.data.memory import DECODING, OverBudgetError
from webviz_displays.shared.geometry import FARTHEST

F32 = NDArray[np.float32]
I64 = NDArray[np.int64]
U8 = NDArray[np.uint8]
Mask = NDArray[np.bool_]

LEVELS = 16
"""Number of levels below the root; the smallest voxels are at this depth."""
MAX_NODES = 3_000_000
"""Largest number of nodes of a tree; they take 600 MB while they are read and drawn."""
NODE_BYTES = 210
"""Bytes of each node meanwhile: 204 were measured."""
_KEPT_BYTES = 40
"""Bytes of each node afterwards, and what is drawn."""

SLOW_BYTES = 20_000
"""A byte is up to four voxels: to read this many, and find what can be seen, takes 20 ms."""

_LOG_ODDS = np.array((np.nan, -2.0, 3.5, -np.inf), np.float32)
"""Log odds by the bits of a child in a binary tree: OctoMap's clamping thresholds, 0.1192 and
0.971. A child with a record has the largest value below it; without any it counts as free."""

_FULL = np.dtype([("log_odds", "<f4"), ("children", "u1")])
_COLORED = np.dtype([("log_odds", "<f4"), ("color", "u1", 3), ("children", "u1")])
_RECORDS = {"OcTree": _FULL, "OcTreeStamped": _FULL, "ColorOcTree": _COLORED}

_CHILDREN = np.arange(8)
_ABSENT, _RECORD = 0, 3
"""Bits of a child in a binary tree."""


class OctreeFault(ValueError):
    """A tree that cannot be read; the text says why."""


class Octree(msgspec.Struct, frozen=True, eq=False, weakref=True):
    """All nodes of a tree, those of one depth after those of the depth above.

    Args:
        kind: such as "OcTree".
        resolution: edge of the smallest voxels in metres.
        codes: (N,), place of the lowest corner along the Morton curve through the smallest voxels:
            bit 3i is bit i of x, 3i + 1 of y, 3i + 2 of z. The centre of the tree is at 2^15.
        depths: (N,), 0 to `LEVELS`.
        is_leaf: (N,).
        log_odds: (N,), of being occupied; that of inner nodes is the largest below them.
        colors: (N, 3), None if the tree has none.
    """

    kind: str
    resolution: float
    codes: I64
    depths: U8
    is_leaf: Mask
    log_odds: F32
    colors: U8 | None


class _Level(NamedTuple):
    """The nodes of one depth.

    Attributes:
        codes: (K,).
        records: (K,), -1 for leaves without one.
        log_odds: (K,), only those of leaves count in a binary tree.
        counts: (K,), their children.
    """

    codes: I64
    records: I64
    log_odds: F32
    counts: I64


@contextlib.contextmanager
def memory_for(message: Any) -> Iterator[None]:
    """Hold the memory that reading and drawing a tree takes, after waiting for that of others.

    Raises:
        OctreeFault: there is not so much.
    """
    if len(message.data) < SLOW_BYTES:  # in the frame loop, which must not wait
        yield
        return
    try:
        with DECODING.take(_nodes_in(message) * NODE_BYTES):
            yield
    except OverBudgetError as error:
        raise OctreeFault(f"The tree {error}. Publish a part of it, or remove displays.") from None


def keep_memory(tree: Octree) -> None:
    """Count the memory of a tree, and of what is drawn of it, while the tree lives.

    Raises:
        OctreeFault: there is not so much.
    """
    try:
        DECODING.hold(tree, len(tree.codes) * _KEPT_BYTES)
    except OverBudgetError as error:
        raise OctreeFault(f"The tree {error}. Publish a part of it, or remove displays.") from None


def _nodes_in(message: Any) -> int:
    """Return the nodes of a tree, by the bits of its records.

    Those that are too many are not counted.
    """
    if message.binary:
        records = _records(message.data, np.dtype("<u2"))
        has_child = (records | records >> 1) & 0x5555
        count = int(np.unpackbits(has_child.view(np.uint8)).sum(dtype=np.int64))
    elif message.id in _RECORDS:
        records = _records(message.data, _RECORDS[message.id])
        count = int(np.unpackbits(records["children"]).sum(dtype=np.int64))
    else:
        return 0
    return min(count + 1, MAX_NODES)


def read_octree(message: Any) -> Octree:
    """Return the tree of an octomap_msgs/msg/Octomap.

    Raises:
        OctreeFault: its data is of an unknown kind, contradicts itself or is too large.
    """
    kind, size = message.id, message.resolution
    if kind not in _RECORDS:
        raise OctreeFault(
            f"Trees of type '{kind[:40]}' are not supported. Publish an OcTree or a ColorOcTree."
        )
    if not len(message.data):
        raise OctreeFault("The tree is empty: the message has no data. Check its publisher.")
    if not 0.0 < size * 2**LEVELS < FARTHEST:
        raise OctreeFault(f"The resolution is {size:g} m. Fix the publisher.")
    tree = (_read_binary if message.binary else _read_full)(kind, size, message.data)
    if len(tree.codes) == 1:
        raise OctreeFault("The tree is empty: it has no node below its root. Check its publisher.")
    return tree


def _read_full(kind: str, size: float, data: NDArray[np.int8]) -> Octree:
    records = _records(data, _RECORDS[kind])
    kinds = np.unpackbits(records["children"][:, None], axis=1, bitorder="little")
    kinds *= np.uint8(_RECORD)
    levels = _levels(kinds, _ends(kinds))
    order = np.concatenate([level.records for level in levels])
    log_odds = records["log_odds"][order]
    colors = records["color"][order] if kind == "ColorOcTree" else None
    return _tree(kind, size, levels, log_odds, colors)


def _read_binary(kind: str, size: float, data: NDArray[np.int8]) -> Octree:
    records = _records(data, np.dtype("<u2"))
    kinds = np.empty((len(records), 8), np.uint8)
    for child in _CHILDREN:
        kinds[:, child] = (records >> np.uint16(2 * child)) & np.uint16(3)
    levels = _levels(kinds, _ends(kinds))
    # From the leaves upwards: an inner node is as occupied as the most occupied of its children.
    log_odds = [level.log_odds for level in levels]
    for depth in range(len(levels) - 2, -1, -1):
        counts = levels[depth].counts
        firsts = (np.cumsum(counts) - counts)[counts > 0]
        log_odds[depth][counts > 0] = np.maximum.reduceat(log_odds[depth + 1], firsts)
    return _tree(kind, size, levels, np.concatenate(log_odds), None)


def _records(data: NDArray[np.int8], dtype: np.dtype[Any]) -> NDArray[Any]:
    """Return the records of a message, at most one more than a tree may have."""
    count = min(len(data) // dtype.itemsize, MAX_NODES + 1)
    return np.frombuffer(np.ascontiguousarray(data).data, dtype, count)


def _tree(
    kind: str, size: float, levels: Sequence[_Level], log_odds: F32, colors: U8 | None
) -> Octree:
    depths = np.repeat(np.arange(len(levels), dtype=np.uint8), [len(x.codes) for x in levels])
    codes = np.concatenate([level.codes for level in levels])
    is_leaf = np.concatenate([level.counts for level in levels]) == 0
    return Octree(kind, size, codes, depths, is_leaf, log_odds, colors)


def _ends(kinds: U8) -> I64:
    """Return the record after the last one below each record, (N,); N ends where the tree does.

    Args:
        kinds: (N, 8), what each child of each record is.

    Raises:
        OctreeFault: the records end before the tree does, or go deeper than a tree can.
    """
    counts = (kinds == _RECORD).sum(axis=1)
    # How many records are still to come after each one, less one. The records below one end at the
    # first one from there on after which one less is to come than before it.
    awaited = np.cumsum(counts - 1)
    ends = np.flatnonzero(awaited < 0)
    if not len(ends):
        raise OctreeFault(_TOO_LARGE if len(kinds) > MAX_NODES else _INCOMPLETE)
    total = int(ends[0]) + 1
    counts, awaited = counts[:total], awaited[:total]
    if awaited.max() > 7 * LEVELS:
        raise OctreeFault(_TOO_DEEP)
    order = np.argsort(awaited.astype(np.int8), kind="stable")
    keys = awaited[order] * total + order
    targets = (awaited - counts) * total + np.arange(total)
    return order[np.searchsorted(keys, targets)] + 1


_INCOMPLETE = "The data ends inside the tree. Publish the tree as a whole."
_TOO_DEEP = f"The tree is deeper than {LEVELS} levels. Fix the publisher."
_TOO_LARGE = (
    f"The tree has more than {MAX_NODES} nodes. Publish a part of it, or at a lower resolution."
)


def _levels(kinds: U8, ends: I64) -> list[_Level]:
    """Return the nodes by depth, those of one parent side by side in their order.

    Args:
        kinds: (N, 8), what each child of each record is.
        ends: (N,), the record after the last one below each.
    """
    root = np.zeros(1, np.int64)
    level = _Level(root, root, _LOG_ODDS[_RECORD:], root.copy())
    levels, total = [], 1
    for depth in range(LEVELS + 1):
        inner = np.flatnonzero(level.records >= 0)
        here = kinds[level.records[inner]]
        is_there = here != _ABSENT
        level.counts[inner] = is_there.sum(axis=1)
        levels.append(level)
        total += int(level.counts.sum())
        if total > MAX_NODES:
            raise OctreeFault(_TOO_LARGE)
        if not is_there.any():
            break
        if depth == LEVELS:
            raise OctreeFault(_TOO_DEEP)
        records = np.full(here.shape, -1)
        following = level.records[inner] + 1
        for child in _CHILDREN:
            has_record = here[:, child] == _RECORD
            records[has_record, child] = following[has_record]
            following[has_record] = ends[following[has_record]]
        codes = level.codes[inner, None] | (_CHILDREN << (3 * (LEVELS - 1 - depth)))
        level_codes = codes[is_there]
        counts = np.zeros(len(level_codes), np.int64)
        level = _Level(level_codes, records[is_there], _LOG_ODDS[here[is_there]], counts)
    return levels
