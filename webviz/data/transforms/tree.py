"""The frames and the walks between them, as in tf2's BufferCore."""

from __future__ import annotations

from collections.abc import Mapping

from webviz.data.transforms.cache import Cache, StaticCache
from webviz.data.transforms.errors import (
    ConnectivityException,
    InvalidArgumentException,
    LookupException,
    TransformException,
)
from webviz.data.transforms.geometry import IDENTITY, PoseTuple, compose, inverse

MAX_DEPTH = 1000
"""Longest chain tf2 walks; a longer one counts as a loop."""


class FrameTree:
    """All frames ever mentioned and the cache of each child.

    Attributes:
        names: frame ids in order of first mention (the child of a transform before its parent).
        caches: per child; a frame known only as a parent has none.
        batches_version: changes when a cache begins or ends to follow messages.
    """

    def __init__(self) -> None:
        self.names: dict[str, None] = {}
        self.caches: dict[str, Cache] = {}
        self.batches_version = 0

    def fault(self, frame: str) -> str:
        """Return the fault of a requested frame id in tf2's words; empty if it is valid."""
        if not frame:
            return "in tf2 frame_ids cannot be empty"
        if frame[0] == "/":
            return "in tf2 frame_ids cannot start with a '/'"
        return "" if frame in self.names else "frame does not exist"

    def validate(self, argument: str, frame: str) -> None:
        """Raise tf2's exception for a frame id that cannot be looked up."""
        fault = self.fault(frame)
        if fault == "frame does not exist":
            raise LookupException(f'"{frame}" passed to {argument} does not exist. ')
        if fault:
            raise InvalidArgumentException(
                f'Invalid argument "{frame}" passed to {argument} - {fault}'
            )

    def latest_common_time(self, target: str, source: str) -> int:
        """Return the newest time for which every link between two known frames has data, as in tf2.

        That is the oldest of the newest stamps along the chain of newest parents; links whose
        newest stamp is 0 (static ones, and moving ones stamped 0) do not count. Without any other
        link it is 0.

        Raises:
            ConnectivityException: the frames have no common ancestor.
            LookupException: the tree contains a loop.
        """
        if target == source:
            cache = self.caches.get(source)
            return cache.newest_stamp if cache else 0
        caches = self.caches
        longest = self._longest()
        ancestors: dict[str, int | None] = {}  # -> newest common time from source up to there
        common: int | None = None
        frame = source
        depth = 0
        while (cache := caches.get(frame)) is not None and (parent := cache.parent) is not None:
            stamp = cache.newest_stamp
            if stamp != 0 and (common is None or stamp < common):
                common = stamp
            frame = parent
            if frame == target:
                return common or 0
            ancestors.setdefault(frame, common)
            depth += 1
            if depth > longest:
                raise self._loop()
        common = None
        frame = target
        depth = 0
        while (cache := caches.get(frame)) is not None and (parent := cache.parent) is not None:
            stamp = cache.newest_stamp
            if stamp != 0 and (common is None or stamp < common):
                common = stamp
            frame = parent
            if frame in ancestors:
                other = ancestors[frame]
                if common is None or (other is not None and other < common):
                    common = other
                return common or 0
            if frame == source:
                return common or 0
            depth += 1
            if depth > longest:
                raise self._loop()
        raise unconnected(target, source)

    def resolve(self, target: str, source: str, stamp_ns: int) -> tuple[PoseTuple, int]:
        """Return the pose of `source` in `target`, and its time: 0 if all links are static.

        The walk from the source stops at the first link without data, and fails only if the walk
        from the target does not arrive there. So frames below a stale common parent still resolve.

        Raises:
            ConnectivityException, ExtrapolationException, LookupException: as tf2.
        """
        if stamp_ns == 0:
            stamp_ns = self.latest_common_time(target, source)
        caches = self.caches
        longest = self._longest()
        stale: Cache | None = None
        pose = IDENTITY
        frame = source
        depth = 0
        while (cache := caches.get(frame)) is not None:
            sample = cache.at(stamp_ns)
            if sample is None:
                stale = cache
                break
            if frame == target:
                return pose, stamp_ns
            pose = sample[0] if pose is IDENTITY else compose(sample[0], pose)
            frame = sample[1]
            depth += 1
            if depth > longest:
                raise self._loop()
        top = frame
        target_pose = IDENTITY
        frame = target
        depth = 0
        while frame != top and (cache := caches.get(frame)) is not None:
            sample = cache.at(stamp_ns)
            if sample is None:
                raise extrapolation(cache, target, source, stamp_ns)
            if frame == source:
                return inverse(target_pose), stamp_ns
            target_pose = sample[0] if target_pose is IDENTITY else compose(sample[0], target_pose)
            frame = sample[1]
            depth += 1
            if depth > longest:
                raise self._loop()
        if frame != top:
            if stale is not None:
                raise extrapolation(stale, target, source, stamp_ns)
            raise unconnected(target, source)
        return compose(inverse(target_pose), pose), stamp_ns

    def can_transform_error(self, target: str, source: str, stamp_ns: int) -> str | None:
        """`TransformBuffer.can_transform_error`."""
        if target == source:
            return None
        for argument, frame in (("target", target), ("source", source)):
            fault = self.fault(frame)
            if fault:
                return (
                    f'Invalid frame ID "{frame}" passed to canTransform argument '
                    f"{argument}_frame - {fault}"
                )
        try:
            self.resolve(target, source, stamp_ns)
        except TransformException as error:
            return str(error)
        return None

    def forget_expired(self, horizon_ns: int) -> list[str]:
        """Forget the moving frames without a transform since a stamp, and return them."""
        expired = [
            child
            for child, cache in self.caches.items()
            if not cache.is_static and cache.newest_stamp < horizon_ns
        ]
        for child in expired:
            del self.caches[child]
        used = self.caches.keys() | {cache.parent for cache in self.caches.values()}
        for name in [name for name in self.names if name not in used]:
            del self.names[name]
        return expired

    def rigid_root(self, frame: str) -> str:
        """`TransformBuffer.rigid_root`."""
        for _ in range(MAX_DEPTH):
            cache = self.caches.get(frame)
            if not isinstance(cache, StaticCache) or cache.sample is None:
                break
            frame = cache.sample[1]
        return frame

    def root(self, frame: str) -> str:
        """Return the uppermost frame above this one now; of a loop, the frame where it closes."""
        return ancestors(self, frame)[-1]

    def as_text(self) -> str:
        """One line per child, as tf2's all_frames_as_string."""
        lines = []
        for name in self.names:
            cache = self.caches.get(name)
            if cache is not None:
                parent = cache.parent or "NO_PARENT"
                lines.append(f"Frame {name} exists with parent {parent}.\n")
        return "".join(lines)

    def _longest(self) -> int:
        """Return the number of steps after which a walk is in a loop, or counts as one."""
        return min(MAX_DEPTH, len(self.caches))

    def _loop(self) -> LookupException:
        return LookupException(
            lambda: f"The tf tree is invalid because it contains a loop.\n{self.as_text()}\n"
        )


def unconnected(target: str, source: str) -> ConnectivityException:
    """tf2's exception for two frames without a common ancestor (its text lacks a space)."""
    return ConnectivityException(
        f"Could not find a connection between '{target}' and '{source}' because they are not part "
        "of the same tree.Tf has two or more unconnected trees."
    )


def extrapolation(cache: Cache, target: str, source: str, stamp_ns: int) -> Exception:
    """tf2's exception for a link of the chain that has no data at the time."""
    assert not isinstance(cache, StaticCache)
    kind, text = cache.refusal(stamp_ns)
    return kind(f"{text}, when looking up transform from frame [{source}] to frame [{target}]")


def ancestors(tree: FrameTree, frame: str) -> list[str]:
    """Return the frame and its current ancestors, up to the root or until a loop closes."""
    chain: dict[str, None] = {}
    while frame not in chain:
        chain[frame] = None
        cache = tree.caches.get(frame)
        if cache is None or cache.parent is None:
            return list(chain)
        frame = cache.parent
    return [*chain, frame]


def roots(tree: FrameTree) -> dict[str, str]:
    """`FrameTree.root` of all frames; for those in or below a loop, one frame of the loop."""
    roots_by_frame: dict[str, str] = {}
    for name in tree.names:
        chain: list[str] = []
        visited: set[str] = set()
        frame = name
        while frame not in roots_by_frame and frame not in visited:
            chain.append(frame)
            visited.add(frame)
            cache = tree.caches.get(frame)
            if cache is None or cache.parent is None:
                break
            frame = cache.parent
        roots_by_frame |= dict.fromkeys(chain, roots_by_frame.get(frame, frame))
    return roots_by_frame


def root_of(frame: str, parents: Mapping[str, str]) -> str:
    """Return the frame at the root of the transforms above a frame."""
    visited = {frame}
    while (parent := parents.get(frame)) is not None and parent not in visited:
        visited.add(parent)
        frame = parent
    return frame
