"""All transforms of a message in one pass, if only their poses changed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz.data.transforms.arrays import F64, canonical_many
from webviz.data.transforms.batches import Batches
from webviz.data.transforms.cache import MAX_SAMPLES, TimeCache
from webviz.data.transforms.publishers import Publishers
from webviz.data.transforms.tree import FrameTree

MAX_LISTS = 256
"""Lists of names whose frames are remembered."""

Names = Sequence[tuple[str, str]]
"""Parents and children."""


class _List(msgspec.Struct):
    """A list of names, its messages, and the caches of the frames that follow them."""

    names: Names
    batches: Batches
    caches: dict[int, TimeCache] = msgspec.field(default_factory=dict)
    """Caches by place in the list, those that have left as well."""
    looked_up: tuple[int, int] = -1, -1
    """Versions of the structure and of the followers for which the caches were looked up."""

    def dismiss(self, is_dismissed: NDArray[np.bool_]) -> None:
        """Let those of these frames leave that follow."""
        for place in np.flatnonzero(self.batches.is_followed & is_dismissed).tolist():
            self.caches[place].leave()


class ManyInserts:
    """Stores what changes nothing but poses; the frames of a list are looked up once.

    Args:
        tree: to store in.
        publishers: of its frames.
        cache_time_ns: history kept of each frame.
    """

    def __init__(
        self, tree: FrameTree, publishers: Mapping[str, Publishers], cache_time_ns: int
    ) -> None:
        self._tree = tree
        self._publishers = publishers
        self._cache_time_ns = cache_time_ns
        self._lists: dict[tuple[int, str], _List] = {}
        """Lists by the identity of the names, which are kept for it, and the authority."""

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
        stamps = np.array(stamps_ns, np.int64)
        entry = self._list(names, authority, structure)
        batches = entry.batches
        entry.dismiss(~batches.fitting(stamps, rows))
        if batches.is_followed.any():
            batches.add(stamps, rows, received_ns)
        return np.flatnonzero(~batches.is_followed).tolist()

    def _list(self, names: Names, authority: str, structure: int) -> _List:
        key = id(names), authority
        entry = self._lists.get(key)
        if entry is None:
            if len(self._lists) >= MAX_LISTS:
                self._forget_all()
            batches = Batches(len(names), self._cache_time_ns, MAX_SAMPLES, self._note)
            entry = self._lists[key] = _List(names, batches)
        if entry.looked_up != (structure, self._tree.batches_version):
            self._look_up(entry, authority)
            entry.looked_up = structure, self._tree.batches_version
        return entry

    def _look_up(self, links: _List, authority: str) -> None:
        """Let all frames of a list follow it that can, and the others leave."""
        for place, (parent, child) in enumerate(links.names):
            cache = self._expected(parent, child, authority)
            if links.batches.is_followed[place] and links.caches[place] is not cache:
                links.caches[place].leave()
            if cache is not None and cache.batches is None:
                cache.follow(links.batches, place)
                links.caches[place] = cache

    def _note(self) -> None:
        self._tree.batches_version += 1

    def _expected(self, parent: str, child: str, authority: str) -> TimeCache | None:
        """Return the cache of a moving frame of this parent and authority."""
        cache, whose = self._tree.caches.get(child), self._publishers.get(child)
        if whose is None or whose.claim != authority or not isinstance(cache, TimeCache):
            return None
        return cache if cache and cache.parent == parent else None

    def _forget_all(self) -> None:
        for entry in self._lists.values():
            entry.dismiss(np.ones(len(entry.names), np.bool_))
        self._lists.clear()
