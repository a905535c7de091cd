"""All transforms of a message in one pass, if only their poses changed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from webviz.data.transforms.arrays import F64, canonical_many
from webviz.data.transforms.cache import TimeCache
from webviz.data.transforms.geometry import PACKED
from webviz.data.transforms.publishers import Publishers
from webviz.data.transforms.tree import FrameTree

MAX_LISTS = 256
"""Lists of names whose frames are remembered."""

Names = Sequence[tuple[str, str]]
"""Parents and children."""

Expected = list[tuple[TimeCache, Publishers, str] | None]
"""The cache, publishers and parent of each frame; None for one that is new, static or moves to
another parent."""


class ManyInserts:
    """Stores what changes nothing but poses; the frames of a list are looked up once.

    Args:
        tree: to store in.
        publishers: of its frames.
    """

    def __init__(self, tree: FrameTree, publishers: Mapping[str, Publishers]) -> None:
        self._tree = tree
        self._publishers = publishers
        self._known: dict[int, tuple[int, Names, Expected]] = {}
        """By the identity of the names, which are kept for it; with the structure's version."""

    def insert(
        self,
        names: Names,
        stamps_ns: Sequence[int],
        poses: F64,
        authority: str,
        received_ns: int,
        structure: int,
    ) -> list[int]:
        """Store the transforms that are expected; see `TransformBuffer.set_moving`.

        They belong to a known moving frame, with the same parent and authority and a later stamp.

        Args:
            names, stamps_ns, poses, authority, received_ns: as there; `names` must not be changed.
            structure: version of the tree's structure.

        Returns:
            The indices of the others, to be stored one by one.
        """
        with np.errstate(all="ignore"):  # a rotation of length zero becomes NaN
            rotations = canonical_many(poses[:, 3:].T)
        rows = np.concatenate((poses[:, :3], rotations.T), axis=1)
        is_finite, packed = np.isfinite(rows.sum(axis=1)).tolist(), rows.tobytes()
        frames = self._expected(names, structure)
        others = []
        for place, (frame, stamp_ns, finite) in enumerate(
            zip(frames, stamps_ns, is_finite, strict=True)
        ):
            if frame is not None and finite:
                cache, whose, parent = frame
                if stamp_ns > cache.stamps[-1] and whose.claim == authority:
                    start = place * PACKED.size
                    cache.append(stamp_ns, packed[start : start + PACKED.size], parent)
                    if received_ns:
                        whose.delay_ns = received_ns - stamp_ns
                    continue
            others.append(place)
        return others

    def _expected(self, names: Names, structure: int) -> Expected:
        known = self._known.get(id(names))
        if known is None or known[0] != structure:
            if len(self._known) >= MAX_LISTS:
                self._known.clear()
            known = structure, names, [self._frame(*pair) for pair in names]
            self._known[id(names)] = known
        return known[2]

    def _frame(self, parent: str, child: str) -> tuple[TimeCache, Publishers, str] | None:
        cache, whose = self._tree.caches.get(child), self._publishers.get(child)
        if whose is None or not isinstance(cache, TimeCache) or not len(cache):
            return None
        return (cache, whose, parent) if cache.parent == parent else None
