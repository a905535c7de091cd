"""One pair of frames at many times, in one pass over arrays."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from itertools import chain, pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from webviz.transforms.arrays import F64, canonical_many, interpolate_many, slerp_weights
from webviz.transforms.cache import Cache, TimeCache
from webviz.transforms.errors import TransformException
from webviz.transforms.geometry import IDENTITY, compose, inverse
from webviz.transforms.tree import MAX_DEPTH, FrameTree

I64 = NDArray[np.int64]


class _Group(NamedTuple):
    """Requests that stand at the same frame on their way up the tree."""

    frame: str
    rows: NDArray[np.intp]
    """Which requests, (n,)."""
    pose: Any
    """Seven floats or arrays (n,): of the start of the walk in `frame`."""


def lookup_many(
    tree: FrameTree, target: str, source: str, stamps_ns: I64
) -> tuple[F64, F64, NDArray[np.bool_]]:
    """`TransformBuffer.lookup_many` for two known frames that differ."""
    poses = np.full((7, len(stamps_ns)), np.nan)
    latest = stamps_ns == 0
    if latest.any():
        try:
            pose, _ = tree.resolve(target, source, 0)
            poses[:, latest] = np.reshape(pose, (7, 1))
        except TransformException:
            pass
    _resolve(tree, target, source, stamps_ns, np.flatnonzero(~latest), poses)
    ok = ~np.isnan(poses[6])
    rotations = np.full((len(stamps_ns), 4), np.nan)
    rotations[ok] = canonical_many(poses[3:, ok]).T
    return poses[:3].T.copy(), rotations, ok


def _resolve(
    tree: FrameTree, target: str, source: str, stamps: I64, index: NDArray[np.intp], out: F64
) -> None:
    """`FrameTree.resolve` for the requests `index`; writes their poses into `out`.

    Requests climb together and part where their parents or their fates differ.
    """
    tops: dict[str, int] = {}
    top_of = np.full(len(stamps), -1)
    in_top = np.empty_like(out)
    waiting = False
    pending = [_Group(source, index, IDENTITY)]
    for _ in range(MAX_DEPTH + 1):
        climbing: list[_Group] = []
        for group in pending:
            if group.frame == target:
                _write(out, group.rows, group.pose)
                continue
            cache = tree.caches.get(group.frame)
            higher, stuck = _climb(cache, group, stamps) if cache else ([], group)
            climbing += higher
            if stuck is not None:
                top_of[stuck.rows] = tops.setdefault(stuck.frame, len(tops))
                _write(in_top, stuck.rows, stuck.pose)
                waiting = True
        pending = climbing
        if not pending:
            break
    if not waiting:
        return

    pending = [_Group(target, np.flatnonzero(top_of >= 0), IDENTITY)]
    for _ in range(MAX_DEPTH + 1):
        climbing = []
        for group in pending:
            met = top_of[group.rows] == tops.get(group.frame, -1)
            done = _part(group, met)
            if len(done.rows):
                pose = in_top[:, done.rows]
                if done.pose is not IDENTITY:
                    pose = compose(inverse(done.pose), pose)
                _write(out, done.rows, pose)
            rest = _part(group, ~met)
            cache = tree.caches.get(rest.frame)
            if rest.frame == source:
                _write(out, rest.rows, inverse(rest.pose))
            elif cache and len(rest.rows):
                climbing += _climb(cache, rest, stamps)[0]
        pending = climbing
        if not pending:
            break


def _write(out: F64, index: NDArray[np.intp], pose: Any) -> None:
    for row, value in zip(out, pose, strict=True):
        row[index] = value


def _part(group: _Group, keep: NDArray[np.bool_]) -> _Group:
    if keep.all():
        return group
    pose = tuple(p[keep] if isinstance(p, np.ndarray) else p for p in group.pose)
    return _Group(group.frame, group.rows[keep], pose)


def _climb(cache: Cache, group: _Group, stamps: I64) -> tuple[list[_Group], _Group | None]:
    """The group one link higher, split by parent; and those for which the link has no data."""
    if not isinstance(cache, TimeCache):
        sample = cache.sample
        assert sample is not None
        return [_Group(sample[1], group.rows, _onto(sample[0], group.pose))], None
    if not cache.stamps:
        return [], group
    times = stamps[group.rows]
    has_data = (times >= cache.stamps[0]) & (times <= cache.stamps[-1])
    stuck = None
    if not has_data.all():
        stuck = _part(group, ~has_data)
        group = _part(group, has_data)
        times = times[has_data]
        if not len(times):
            return [], stuck
    pose, parents = _sample(cache, times)
    pose = _onto(pose, group.pose)
    if isinstance(parents, str):
        return [_Group(parents, group.rows, pose)], stuck
    higher = [
        _part(_Group(str(parent), group.rows, pose), parents == parent)
        for parent in np.unique(parents)
    ]
    return higher, stuck


def _onto(link: Any, pose: Any) -> Any:
    return link if pose is IDENTITY else compose(link, pose)


def _sample(cache: TimeCache, times: I64) -> tuple[Any, str | NDArray[np.str_]]:
    """`TimeCache.at` for many times within the history: poses, and the parent or parents."""
    low = max(bisect_left(cache.stamps, int(times.min())) - 1, 0)
    high = bisect_right(cache.stamps, int(times.max())) + 1
    known = np.array(cache.stamps[low:high], dtype=np.int64)
    samples = cache.samples[low:high]
    flat = chain.from_iterable(pose for pose, _ in samples)
    start = np.fromiter(flat, np.float64, 7 * len(samples)).reshape(-1, 7).T.copy()
    parents = [parent for _, parent in samples]

    # Each sample with its successor; the last one, and one before a change of parent, stands still.
    end = np.concatenate((start[:, 1:], start[:, -1:]), axis=1)
    span = np.append(np.maximum(np.diff(known), 1), 1).astype(np.float64)
    one_parent = parents.count(parents[0]) == len(parents)
    if not one_parent:
        held = np.array([*(a != b for a, b in pairwise(parents)), False])
        end[:, held] = start[:, held]

    i = np.searchsorted(known, times, side="right") - 1
    if low == 0 and cache.stamps[0] != cache.stamps[-1]:
        i[times == known[0]] = 0  # of equal oldest stamps tf2 gives the first
    theta, scale, sign = slerp_weights(start[3:], end[3:])
    pairs = np.take(np.vstack((start, end, theta, scale, sign, span)), i, axis=1)
    ratio = (times - known[i]) / pairs[17]
    pose = interpolate_many(pairs[:7], pairs[7:14], ratio, pairs[14], pairs[15], pairs[16])
    return pose, parents[0] if one_parent else np.array(parents)[i]
