"""The shape of the tree, derived once per structure; a tick is then arithmetic on arrays."""

from __future__ import annotations

from collections.abc import Sequence

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
    poses_to_rows,
    to_pairs,
    to_rows,
)
from webviz.data.transforms.batches import Batches
from webviz.data.transforms.cache import StaticCache, TimeCache
from webviz.data.transforms.geometry import IDENTITY, PoseTuple
from webviz.data.transforms.tree import FrameTree

I64 = NDArray[np.int64]
Jumps = list[tuple[I64, I64]]
"""Steps of all nodes towards their ends (pointer jumping): in each, rows adopt the results of the
nodes that they have reached, so that every step is twice as long as the previous one."""

MAX_STAMPS = 8
"""Latest common times of one tick; each takes a pass over all links."""

_ALWAYS = np.iinfo(np.int64).max


class Topology:
    """Frames, their ancestors, and where they meet a target frame.

    Valid until a frame, a parent or a static pose changes.

    Args:
        tree: the frames.
        target: frame to express poses in.
        frames: requested frames; unknown ones have no pose.
    """

    def __init__(self, tree: FrameTree, target: str, frames: Sequence[str]) -> None:
        self._tree = tree
        self._grouped_at = -1
        self._alone: list[int] = []
        """Moving frames that follow no messages."""
        self._followers: list[tuple[Batches, I64, I64]] = []
        """The messages that others follow, with their numbers and their places there."""
        self._nodes: dict[str, int] = {}
        self._parents: list[int] = []
        self.is_usable = self._climb(tree, target)
        """True if the target is neither in nor below a loop."""
        if not self.is_usable:
            return
        for frame in frames:
            self._climb(tree, frame)
        parents = np.array(self._parents, np.int64)
        caches = [tree.caches.get(name) for name in self._nodes]
        self._base = self._nodes[target]
        self._target_cache = caches[self._base]
        spine = [self._base]
        while (above := self._parents[spine[-1]]) >= 0:
            spine.append(above)
        self._spine = np.array(spine)
        self._jumps, _ = _jumps(parents)
        cut = parents.copy()
        cut[self._spine] = -1
        self._jumps_to_spine, self._meets = _jumps(cut)
        self._ups = parents

        moving = [(i, c) for i, c in enumerate(caches) if isinstance(c, TimeCache) and len(c)]
        self._moving = [cache for _, cache in moving]
        self._moving_nodes = np.array([i for i, _ in moving], np.int64)
        self._links = np.tile(IDENTITY_PAIRS, (1, len(parents)))
        """The newest pose of every node in its parent; those of static links stay."""
        for node, cache in enumerate(caches):
            if isinstance(cache, StaticCache) and cache.sample is not None:
                self._links[:, node] = to_pairs(poses_to_rows([cache.sample[0]]))[:, 0]

        self._queries = np.array([self._nodes[frame] for frame in frames], np.int64)
        is_known = np.array([not tree.fault(frame) for frame in frames], np.bool_)
        is_joined = np.isin(self._meets[self._queries], self._spine)
        self._is_found = is_known & is_joined if not tree.fault(target) else np.zeros_like(is_known)
        self._is_target = self._queries == self._base

    def _climb(self, tree: FrameTree, frame: str) -> bool:
        """Assign numbers to a frame and its ancestors, parents first; return if they form no loop.

        Then they get no pose: the frame at which the loop closes counts as a root.
        """
        climbed: dict[str, None] = {}
        above: str | None = frame
        is_loop = False
        while above is not None and above not in self._nodes:
            if is_loop := above in climbed:
                above = None
                break
            climbed[above] = None
            cache = tree.caches.get(above)
            above = cache.parent if cache is not None else None
        parent = -1 if above is None else self._nodes[above]
        for name in reversed(climbed):
            self._nodes[name] = len(self._parents)
            self._parents.append(parent)
            parent = self._nodes[name]
        return not is_loop

    def poses(self) -> tuple[F64, I64] | None:
        """Return the poses of all frames in the target, each at its latest common time with it.

        Returns:
            float64 (7, N), NaN where there is none, and int64 (N,) the times: 0 if all links are
            static or there is no pose. None if frames have too many different times, or a link has
            no data at one of them: then `many_frames` computes them link by link.
        """
        newest = np.full(len(self._ups), 0, np.int64)
        self._group()
        alone = [self._moving[number] for number in self._alone]
        newest[self._moving_nodes[self._alone]] = [cache.newest_stamp for cache in alone]
        for batches, numbers, places in self._followers:
            newest[self._moving_nodes[numbers]] = batches.newest_ns[places]
        stamps = np.where(self._is_found, self._common_times(newest)[self._queries], 0)
        is_wanted = self._is_found & ~self._is_target
        out = np.full((7, len(stamps)), np.nan)
        times = np.unique(stamps[is_wanted]).tolist()
        if len(times) > MAX_STAMPS:
            return None
        if self._moving:
            rows = np.empty((7, len(self._moving)))
            rows[:, self._alone] = packed_to_rows(b"".join([cache.poses[-1] for cache in alone]))
            for batches, numbers, places in self._followers:
                rows[:, numbers] = batches.rows[places].T
            self._links[:, self._moving_nodes] = to_pairs(rows)
        for time in times:
            chosen = np.flatnonzero(is_wanted & (stamps == time))
            poses = self._in_roots(time, newest, self._queries[chosen])
            if poses is None:
                return None
            chosen_poses = poses[:, self._queries[chosen]]
            if self._ups[self._base] >= 0:
                chosen_poses = compose_many(inverse_many(poses[:, [self._base]]), chosen_poses)
            rows = to_rows(chosen_poses)
            out[:3, chosen] = rows[:3]
            out[3:, chosen] = canonical_many(rows[3:])
        out[:, self._is_target] = np.array(IDENTITY)[:, None]
        own = self._target_cache.newest_stamp if self._target_cache else 0
        return out, np.where(self._is_target, own, stamps)

    def _group(self) -> None:
        """Sort the moving frames by the messages that they follow."""
        if self._grouped_at == self._tree.batches_version:
            return
        self._grouped_at = self._tree.batches_version
        by_batches: dict[Batches | None, list[int]] = {None: []}
        for number, cache in enumerate(self._moving):
            by_batches.setdefault(cache.batches, []).append(number)
        self._alone = by_batches.pop(None)
        self._followers = [
            (batches, np.array(numbers), np.array([self._moving[each].place for each in numbers]))
            for batches, numbers in by_batches.items()
            if batches is not None
        ]

    def _common_times(self, newest: I64) -> I64:
        """Return the latest time common with the target per node; 0 where no link has one."""
        # A stamp of 0 does not count: those of static links, and of moving ones stamped so.
        times = np.where(newest == 0, _ALWAYS, newest)
        below = times.copy()
        below[self._spine] = _ALWAYS
        for rows, ups in self._jumps_to_spine:
            below[rows] = np.minimum(below[rows], below[ups])
        above = np.full(len(times), _ALWAYS)
        above[self._spine[1:]] = np.minimum.accumulate(times[self._spine[:-1]])
        common = np.minimum(below, above[self._meets])
        return np.where(common == _ALWAYS, 0, common)

    def _in_roots(self, time: int, newest: I64, queries: I64) -> C128 | None:
        """Pairs (4, nodes): the poses of requested nodes and the target in their roots."""
        poses = self._links.copy()
        is_ahead = newest[self._moving_nodes] != time
        if time and is_ahead.any():  # not if one message has all of them
            is_needed = np.zeros(len(newest), np.bool_)
            is_needed[queries] = is_needed[self._base] = True
            self._mark_ancestors(is_needed)
            needed = is_needed[self._moving_nodes] & is_ahead
            starts: list[PoseTuple] = []
            ends: list[PoseTuple] = []
            ratios: list[float] = []
            for place in np.flatnonzero(needed).tolist():
                bracket = self._moving[place].bracket(time)
                if bracket is None or bracket[3] != self._moving[place].parent:
                    return None  # no data, or another parent at that time
                starts.append(bracket[0])
                ends.append(bracket[1])
                ratios.append(bracket[2])
            if starts:
                table = interpolation_table(poses_to_rows(starts), poses_to_rows(ends))
                nodes = self._moving_nodes[needed]
                poses[:, nodes] = interpolate_many(table, np.array(ratios))
        for rows, ups in self._jumps:
            poses[:, rows] = compose_many(poses[:, ups], poses[:, rows])
        return poses

    def _mark_ancestors(self, is_needed: NDArray[np.bool_]) -> None:
        """Mark all ancestors of marked nodes."""
        nodes = np.flatnonzero(is_needed)
        while len(nodes):
            above = self._ups[nodes]
            above = np.unique(above[above >= 0])
            nodes = above[~is_needed[above]]
            is_needed[nodes] = True


def _jumps(parents: I64) -> tuple[Jumps, I64]:
    """Return the steps by which all nodes reach their roots, and the roots.

    Args:
        parents: (N,), -1 at the uppermost nodes.
    """
    steps: Jumps = []
    nodes = np.arange(len(parents))
    ups = np.where(parents < 0, nodes, parents)
    while True:
        rows = np.flatnonzero(parents[ups] >= 0)
        if not len(rows):
            return steps, ups
        steps.append((rows, ups[rows]))
        ups[rows] = ups[ups[rows]]
