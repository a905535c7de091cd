"""All transforms of a message in one pass, if only their poses changed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np

from webviz.data.transforms.arrays import F64, canonical_many
from webviz.data.transforms.cache import TimeCache
from webviz.data.transforms.publishers import Publishers
from webviz.data.transforms.tree import FrameTree


def insert_expected(
    tree: FrameTree,
    publishers: Mapping[str, Publishers],
    names: Iterable[tuple[str, str]],
    stamps_ns: Iterable[int],
    poses: F64,
    authority: str,
    received_ns: int,
) -> list[int]:
    """Store the transforms that change nothing but a pose; see `TransformBuffer.set_moving`.

    They belong to a known moving frame, with the same parent and authority and a later stamp.

    Returns:
        The indices of the others, to be stored one by one.
    """
    caches = tree.caches
    with np.errstate(all="ignore"):  # a rotation of length zero becomes NaN
        rotations = canonical_many(poses[:, 3:].T).T
    canonical = np.concatenate((poses[:, :3], rotations), axis=1)
    is_finite = np.isfinite(canonical.sum(axis=1)).tolist()
    rows = zip(names, stamps_ns, canonical.tolist(), is_finite, strict=True)
    others = []
    for place, ((parent, child), stamp_ns, (x, y, z, qx, qy, qz, qw), finite) in enumerate(rows):
        cache, whose = caches.get(child), publishers.get(child)
        if (
            finite
            and isinstance(cache, TimeCache)
            and cache.samples
            and stamp_ns > cache.stamps[-1]
            and cache.samples[-1][1] == parent
            and whose is not None
            and whose.claim == authority
        ):
            cache.insert(stamp_ns, ((x, y, z, qx, qy, qz, qw), parent))
            if received_ns:
                whose.delay_ns = received_ns - stamp_ns
        else:
            others.append(place)
    return others
