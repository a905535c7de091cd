"""One pair of frames at many times, in passes over arrays."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from contextlib import suppress
from itertools import islice, pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from webviz.data.transforms.arrays import (
    C128,
    F64,
    IDENTITY_PAIRS,
    canonical_many,
    compose_many,
    interpolate_many,
    interpolation_table,
    inverse_many,
    packed_to_rows,
    to_pairs,
    to_rows,
)
from webviz.data.transforms.cache import TimeCache
from webviz.data.transforms.errors import TransformException
from webviz.data.transforms.geometry import IDENTITY, canonical
from webviz.data.transforms.tree import MAX_DEPTH, FrameTree

I64 = NDArray[np.int64]

BLOCK = 2048
"""Requests at a time, so that the arrays of a pass stay in the processor's cache (measured)."""


def lookup_many(
    tree: FrameTree, target: str, source: str, stamps_ns: I64
) -> tuple[F64, F64, NDArray[np.bool_]]:
    """`TransformBuffer.lookup_many`."""
    stamps_ns = np.asarray(stamps_ns, np.int64)
    count = len(stamps_ns)
    if target == source:
        rotations = np.tile(IDENTITY[3:], (count, 1))
        return np.zeros((count, 3)), rotations, np.ones(count, bool)
    if tree.fault(target) or tree.fault(source):
        return np.full((count, 3), np.nan), np.full((count, 4), np.nan), np.zeros(count, bool)
    order = None
    ascending = stamps_ns
    if (np.diff(stamps_ns) < 0).any():
        order = np.argsort(stamps_ns)
        ascending = stamps_ns[order]
    poses = np.empty((7, count))
    histories = _Histories(tree, ascending)
    for start in range(0, len(ascending), BLOCK):
        part = slice(start, start + BLOCK)
        rows = to_rows(_resolve(histories, target, source, ascending[part]))
        rows[3:] = canonical_many(rows[3:])
        poses[:, part] = rows
    latest = ascending == 0
    if latest.any():
        poses[:, latest] = np.nan
        with suppress(TransformException):
            pose, _ = tree.resolve(target, source, 0)
            poses[:, latest] = np.reshape((*pose[:3], *canonical(*pose[3:])), (7, 1))
    if order is not None:
        sorted_poses, poses = poses, np.empty_like(poses)
        poses[:, order] = sorted_poses
    return poses[:3].T, poses[3:].T, ~np.isnan(poses[6])


class _History:
    """The samples of a cache around the requested times, as arrays over these M samples."""

    def __init__(self, cache: TimeCache, first_ns: int, last_ns: int) -> None:
        stamps = cache.stamps
        low = max(bisect_left(stamps, first_ns) - 1, 0)
        high = bisect_right(stamps, last_ns) + 1
        self.oldest_ns, self.newest_ns = stamps[0], stamps[-1]
        self._stamp_list = list(islice(stamps, low, high))
        self.stamps = np.array(self._stamp_list, np.int64)
        # Each sample with its successor; the last, and one before a change of parent, with itself.
        start = packed_to_rows(b"".join(islice(cache.poses, low, high)))
        end = np.concatenate((start[:, 1:], start[:, -1:]), axis=1)
        self.parent: str | None = None
        self.parents: NDArray[np.object_] | None = None
        if self._stamp_list[0] > cache.mixed_ns:
            self.parent = cache.parents[-1]
        else:
            parents = list(islice(cache.parents, low, high))
            self.parents = np.array(parents, object)
            changes = np.flatnonzero([a != b for a, b in pairwise(parents)])
            end[:, changes] = start[:, changes]
        span = np.append(np.maximum(np.diff(self.stamps), 1), 1)
        since_first = (self.stamps - first_ns).astype(np.float64)
        self.table = np.concatenate(
            (interpolation_table(start, end), since_first[None], 1.0 / span[None])
        )
        self._first_ns = first_ns

    def at(self, times: I64) -> tuple[C128, str | NDArray[np.object_]]:
        """`TimeCache.at` for ascending times within the history.

        Returns:
            Pairs (4, n), and the parent or parents.
        """
        # The number of times from the stamp of each sample up to the next one.
        low = max(bisect_left(self._stamp_list, int(times[0])) - 1, 0)
        part = slice(low, bisect_right(self._stamp_list, int(times[-1]), low))
        stamps = self.stamps[part]
        first = np.searchsorted(times, stamps)
        if self.oldest_ns != self.newest_ns and times[0] == self.oldest_ns:
            # Of equal oldest stamps tf2 gives the first.
            equal = np.searchsorted(times, self.oldest_ns, side="right")
            first[1:] = np.maximum(first[1:], equal)
        counts = np.empty_like(first)
        np.subtract(first[1:], first[:-1], out=counts[:-1])
        counts[-1] = len(times) - first[-1]
        table = np.repeat(self.table[:, part], counts, axis=1)
        pose = interpolate_many(table, (times - self._first_ns - table[15]) * table[16])
        if self.parents is None:
            assert self.parent is not None
            return pose, self.parent
        return pose, np.repeat(self.parents[part], counts)


class _Histories:
    """The histories that a request needs, each made once."""

    def __init__(self, tree: FrameTree, stamps: I64) -> None:
        self.caches = tree.caches
        nonzero = stamps[stamps != 0]
        self._first, self._last = (
            (int(nonzero.min()), int(nonzero.max())) if len(nonzero) else (0, 0)
        )
        self._histories: dict[str, _History] = {}

    def of(self, frame: str, cache: TimeCache) -> _History:
        """Return the history of a frame whose cache is not empty."""
        if frame not in self._histories:
            self._histories[frame] = _History(cache, self._first, self._last)
        return self._histories[frame]


class _Group(NamedTuple):
    """Requests at the same frame on their way up the tree, ascending by time."""

    frame: str
    rows: NDArray[np.intp] | slice
    """Indices of requests, (n,); a slice stands for all of them."""
    pose: C128 | None
    """The start of the walk in `frame`, pairs (4, n) or one for all (4, 1); None: the identity."""


def _resolve(histories: _Histories, target: str, source: str, stamps: I64) -> C128:
    """`FrameTree.resolve` for stamps other than 0: pairs (4, N), NaN where there is no pose.

    Requests climb in groups, which split where parents differ or data is missing.
    """
    out = np.full((4, len(stamps)), complex(np.nan, np.nan))
    tops: dict[str, int] = {}
    top_of = np.full(len(stamps), -1)
    in_top = np.empty_like(out)
    waiting = False
    pending = [_Group(source, slice(None), None)]
    for _ in range(MAX_DEPTH + 1):
        climbing: list[_Group] = []
        for group in pending:
            if group.frame == target:
                out[:, group.rows] = group.pose
                continue
            higher, stuck = _climb(histories, group, stamps)
            climbing += higher
            if stuck is not None:
                top_of[stuck.rows] = tops.setdefault(stuck.frame, len(tops))
                in_top[:, stuck.rows] = IDENTITY_PAIRS if stuck.pose is None else stuck.pose
                waiting = True
        pending = climbing
        if not pending:
            break
    if not waiting:
        return out

    pending = [_Group(target, np.flatnonzero(top_of >= 0), None)]
    for _ in range(MAX_DEPTH + 1):
        climbing = []
        for group in pending:
            met = top_of[group.rows] == tops.get(group.frame, -1)
            if met.any():
                resolved = _part(group, met)
                pose = in_top[:, resolved.rows]
                if resolved.pose is not None:
                    pose = compose_many(inverse_many(resolved.pose), pose)
                out[:, resolved.rows] = pose
            if met.all():
                continue
            rest = _part(group, ~met)
            if rest.frame == source:
                assert rest.pose is not None
                out[:, rest.rows] = inverse_many(rest.pose)
            else:
                climbing += _climb(histories, rest, stamps)[0]
        pending = climbing
        if not pending:
            break
    return out


def _part(group: _Group, keep: NDArray[np.bool_]) -> _Group:
    if keep.all():
        return group
    pose = group.pose
    if pose is not None and pose.shape[1] > 1:
        pose = pose[:, keep]
    rows = np.flatnonzero(keep) if isinstance(group.rows, slice) else group.rows[keep]
    return _Group(group.frame, rows, pose)


def _climb(histories: _Histories, group: _Group, stamps: I64) -> tuple[list[_Group], _Group | None]:
    """Return the group one link higher, split by parent; and the requests without such a link."""
    cache = histories.caches.get(group.frame)
    if cache is None or cache.parent is None:
        return [], group
    if not isinstance(cache, TimeCache):
        assert cache.sample is not None
        pose, parent = cache.sample
        return [
            _Group(parent, group.rows, _onto(to_pairs(np.reshape(pose, (7, 1))), group.pose))
        ], None
    times = stamps[group.rows]
    stuck = None
    oldest, newest = cache.stamps[0], cache.stamps[-1]
    if not 0 < times[0] >= oldest or times[-1] > newest:
        has_data = (times >= oldest) & (times <= newest) & (times != 0)
        stuck = _part(group, ~has_data)
        group = _part(group, has_data)
        times = times[has_data]
        if not len(times):
            return [], stuck
    pose, parents = histories.of(group.frame, cache).at(times)
    pose = _onto(pose, group.pose)
    if isinstance(parents, str):
        return [_Group(parents, group.rows, pose)], stuck
    higher = [
        _part(_Group(parent, group.rows, pose), parents == parent) for parent in np.unique(parents)
    ]
    return higher, stuck


def _onto(link: C128, pose: C128 | None) -> C128:
    return link if pose is None else compose_many(link, pose)
