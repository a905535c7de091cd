"""A static frame whose pose is replaced for a while, such as to try another mounting."""

from __future__ import annotations

from webviz.data.transforms.buffer import TransformBuffer
from webviz.data.transforms.cache import ParentedPose, StaticCache
from webviz.data.transforms.geometry import PoseTuple


class PinnedCache(StaticCache):
    """A cache that answers with a pose of its own, and keeps what is published meanwhile.

    Args:
        published: the cache it stands in for.
    """

    __slots__ = ("published",)

    def __init__(self, published: StaticCache) -> None:
        super().__init__()
        self.sample = published.sample
        self.published = published

    def insert(self, stamp_ns: int, sample: ParentedPose) -> bool:
        """Keep what is published; the pinned pose stays."""
        return self.published.insert(stamp_ns, sample)


def pin(buffer: TransformBuffer, frame: str, pose: PoseTuple) -> bool:
    """Replace the pose of a static frame in its parent until `unpin`, whatever is published.

    Args:
        buffer: has the frame.
        frame: id of the frame.
        pose: in its parent, with a unit quaternion.

    Returns:
        Whether it is done; only static frames can be pinned.
    """
    cache = buffer.tree.caches.get(frame)
    if not isinstance(cache, StaticCache) or (parent := cache.parent) is None:
        return False
    if not isinstance(cache, PinnedCache):
        cache = buffer.tree.caches[frame] = PinnedCache(cache)
    cache.sample = pose, parent
    _note(buffer)
    return True


def unpin(buffer: TransformBuffer, frame: str) -> None:
    """Return to what is published about a frame; nothing happens if it is not pinned."""
    cache = buffer.tree.caches.get(frame)
    if isinstance(cache, PinnedCache):
        buffer.tree.caches[frame] = cache.published
        _note(buffer)


def is_pinned(buffer: TransformBuffer, frame: str) -> bool:
    """Return whether a frame is pinned; not any more if it became a moving one."""
    return isinstance(buffer.tree.caches.get(frame), PinnedCache)


def _note(buffer: TransformBuffer) -> None:
    """Let all that was computed from the static pose be computed again."""
    buffer.version += 1
    buffer.structure_version += 1
