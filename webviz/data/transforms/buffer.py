"""The transform buffer: tf2's BufferCore in plain Python."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from math import isnan

import numpy as np
from numpy.typing import NDArray

from webviz.data.transforms import many_frames
from webviz.data.transforms.cache import NEVER_NS, Cache, StaticCache, TimeCache
from webviz.data.transforms.conflicts import Conflicts
from webviz.data.transforms.errors import NS_PER_S, TransformException
from webviz.data.transforms.geometry import IDENTITY, PoseTuple, canonical, compose_as_matrices
from webviz.data.transforms.listing import frames_as_yaml
from webviz.data.transforms.many_frames import FramesIn
from webviz.data.transforms.many_inserts import ManyInserts
from webviz.data.transforms.many_stamps import lookup_many
from webviz.data.transforms.publishers import Claim, Publishers
from webviz.data.transforms.records import NewestTransform, Transform, fault_of, too_old
from webviz.data.transforms.refusals import Refusals
from webviz.data.transforms.topology import Topology
from webviz.data.transforms.tree import FrameTree, roots

QUATERNION_TOLERANCE = 10e-3
"""Tolerance of the squared length of a normalised quaternion around 1 (tf2's constant)."""
MAX_FRAMES = 20_000
"""Frames that are kept; tf2 has no limit."""
MAX_FOUND = 100
"""Results of `lookup` that are kept until the next transform."""

_SILENT = np.errstate(over="ignore", invalid="ignore")
"""Huge transforms compose to infinity and NaN silently, as floats do."""


class TransformBuffer:
    """The transforms of the last seconds, from which it computes poses at any time.

    Results and error texts are those of tf2's BufferCore (ROS 2 Jazzy). A stamp is an int in
    nanoseconds; 0 asks for the latest time common to all links of the chain.

    There is deliberately no lock: only the frame loop inserts, clears and reads. It decodes and
    inserts messages at the start of a tick, so that all lookups of a tick see one state.

    Args:
        cache_time_ns: history kept of each moving frame (tf2's and RViz's default is 10 s).

    Attributes:
        nodes: the node of each authority, if known; sentences name it.
        recorded: when the first transforms of a bag come, such as "the bag's first is at 0.8 s"; ""
            for live ones.
        none_recorded: whether the source is a bag without transforms, so that none will come.
        conflicts: the signs of two publishers of a frame.
        refusals: the transforms that were not stored.
        version: changes whenever something is stored, pruned or cleared.
        structure_version: changes when a frame, a parent, a static pose or the kind of a frame
            changes: results that depend only on the tree's shape can be cached until then.
    """

    def __init__(self, cache_time_ns: int = 10 * NS_PER_S) -> None:
        self.cache_time_ns = cache_time_ns
        self.nodes: Mapping[str, str] = {}
        self.recorded = ""
        self.none_recorded = False
        self.version = 0
        self.structure_version = 0
        self._tree = FrameTree()
        self._publishers: dict[str, Publishers] = {}
        self.refusals = Refusals()
        self.conflicts = Conflicts(self._tree.caches, self._publishers, cache_time_ns)
        self._room_made_ns = NEVER_NS
        self._many = ManyInserts(self._tree, self._publishers, cache_time_ns)
        self._topology: tuple[tuple[int, str, list[str]], Topology] | None = None
        """The cached shape of the last query for many frames, by structure version and query."""
        self._largest: tuple[int, tuple[str, int]] | None = None
        self._lookups: dict[tuple[str, str, int], Transform] = {}
        """Results of `lookup` at `_found_at`: a message is placed when it comes and when drawn."""
        self._found_at = 0, 0

    @property
    def tree(self) -> FrameTree:
        """The frames and their samples; for reading."""
        return self._tree

    @property
    def publishers(self) -> Mapping[str, Publishers]:
        """The publishers per child frame."""
        return self._publishers

    def set_transform(
        self,
        parent: str,
        child: str,
        stamp_ns: int,
        translation: tuple[float, float, float],
        rotation: tuple[float, float, float, float],
        is_static: bool = False,
        authority: str = "",
        received_ns: int = 0,
    ) -> bool:
        """Store the pose of `child` in `parent`.

        One leading slash is stripped from the frame ids. The quaternion (x, y, z, w) may have any
        length but zero. A frame that changes between static and moving loses its history.

        Args:
            parent: frame id.
            child: frame id.
            stamp_ns: time of the pose; ignored for a static transform.
            translation: (x, y, z) in metres; infinity is accepted, NaN is not.
            rotation: (x, y, z, w).
            is_static: whether it holds at all times.
            authority: the publisher, if known.
            received_ns: time of reception, for the diagnosis; 0 if unknown.

        Returns:
            Whether it was stored (a repeated sample counts as stored); if not, `refusals` has the
            reason.
        """
        if parent[:1] == "/":
            parent = parent[1:]
        if child[:1] == "/":
            child = child[1:]
        x, y, z = translation
        qx, qy, qz, qw = canonical(*rotation)
        if (
            child == parent
            or not child
            or not parent
            or isnan(x)
            or isnan(y)
            or isnan(z)
            or not abs(qw * qw + qx * qx + qy * qy + qz * qz - 1.0) < QUATERNION_TOLERANCE
        ):
            fault = fault_of(parent, child, translation)
            self.refusals.reject((parent, child), stamp_ns, received_ns, fault, is_static)
            return False

        tree = self._tree
        cache = tree.caches.get(child)
        is_named = cache is not None and parent in tree.names
        if not is_named and not self._has_room(child, stamp_ns, received_ns):
            return False
        if cache is None or cache.is_static != is_static:
            cache = self._new_cache(parent, child, is_static)
        elif not is_named:
            tree.names[parent] = None
            self.structure_version += 1
        before, newest_ns = cache.newest if is_static else cache.parent, cache.newest_stamp
        sample = ((x, y, z, qx, qy, qz, qw), parent)
        self.version += 1  # a refused sample prunes, too
        if not cache.insert(stamp_ns, sample):
            fault = too_old(stamp_ns, cache.newest_stamp)
            self.refusals.reject((parent, child), stamp_ns, received_ns, fault)
            return False
        if is_static:
            self.refusals.replace(child)
        if before != (cache.newest if is_static else cache.parent):
            self.structure_version += 1
        self._claim(child, sample if is_static else authority, authority, stamp_ns)
        if received_ns:
            cache.delay_ns = received_ns - stamp_ns
            if before != cache.newest if is_static else cache.newest_stamp != newest_ns:
                cache.seen_ns = received_ns
        return True

    def set_moving(
        self,
        names: Sequence[tuple[str, str]],
        stamps_ns: Sequence[int],
        poses: NDArray[np.float64],
        authority: str,
        received_ns: int,
    ) -> None:
        """`set_transform` for N moving transforms of one message.

        Args:
            names: N pairs of a parent and its child; not to be changed afterwards.
            stamps_ns: N stamps.
            poses: float64 (N, 7), translations in metres and rotations (x, y, z, w).
            authority: their publisher.
            received_ns: time of reception.
        """
        others = self._many.insert(
            names, stamps_ns, poses, authority, received_ns, self.structure_version
        )
        self.version += len(names) - len(others)
        for place in others:
            parent, child = names[place]
            x, y, z, qx, qy, qz, qw = poses[place].tolist()
            self.set_transform(
                *(parent, child, stamps_ns[place], (x, y, z), (qx, qy, qz, qw)),
                *(False, authority, received_ns),
            )

    def lookup(self, target: str, source: str, stamp_ns: int) -> Transform:
        """Return the pose of `source` in `target` at a time; 0 means the latest common time.

        The same frame twice gives the identity, even if it does not exist.

        Raises:
            InvalidArgumentException: a frame id is empty or starts with a slash.
            LookupException: a frame is unknown, or the tree contains a loop.
            ConnectivityException: nothing connects the frames.
            ExtrapolationException: a link has no data around that time; one of its three kinds.
        """
        versions = self.version, self.structure_version
        if self._found_at != versions or len(self._lookups) >= MAX_FOUND:
            self._found_at, self._lookups = versions, {}
        key = target, source, stamp_ns
        if (transform := self._lookups.get(key)) is None:
            transform = self._lookups[key] = Transform.of(*self._pose(target, source, stamp_ns))
        return transform

    @_SILENT
    def lookup_many(
        self, target: str, source: str, stamps_ns: NDArray[np.int64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]]:
        """`lookup` at many times, such as those of a scan's beams: int64 (N,) in any order.

        Returns:
            Translations float64 (N, 3) in metres, rotations float64 (N, 4) as (x, y, z, w), and
            bool (N,): whether `lookup` would succeed. The other poses are NaN.
        """
        return lookup_many(self._tree, target, source, stamps_ns)

    @_SILENT
    def poses_in(
        self, target: str, frames: Iterable[str] | None = None, stamp_ns: int = 0
    ) -> FramesIn:
        """`lookup(target, frame, stamp_ns)` for many frames in one pass.

        Args:
            target: frame to express the poses in.
            frames: requested frames; by default all of `frames()`.
            stamp_ns: one time for all; 0 for the latest common time of each with the target.
        """
        names = self.frames() if frames is None else list(frames)
        if stamp_ns == 0 and len(names) >= many_frames.ARRAYS_PAY_FROM:
            topology = self._topology_of(target, names)
            if topology.is_usable and (poses := topology.poses()):
                return FramesIn.of(names, *poses)
        valid = set() if self._tree.fault(target) else {n for n in names if not self._tree.fault(n)}
        return many_frames.poses_in(self._tree, target, names, valid, stamp_ns)

    def lookup_full(
        self, target: str, target_stamp_ns: int, source: str, source_stamp_ns: int, fixed: str
    ) -> Transform:
        """Return the pose of `source` at one time in `target` at another; `fixed` does not move.

        The returned stamp is that of the target.

        Raises:
            TransformException: as `lookup`, for each of the two steps.
        """
        self._tree.validate("lookupTransform argument target_frame", target)
        self._tree.validate("lookupTransform argument source_frame", source)
        self._tree.validate("lookupTransform argument fixed_frame", fixed)
        to_fixed, _ = self._pose(fixed, source, source_stamp_ns)
        to_target, stamp_ns = self._pose(target, fixed, target_stamp_ns)
        pose = compose_as_matrices(to_target, to_fixed)
        return Transform(pose[:3], pose[3:], stamp_ns)

    def can_transform(self, target: str, source: str, stamp_ns: int) -> bool:
        """Return whether `lookup` would succeed."""
        try:
            self._pose(target, source, stamp_ns)
        except TransformException:
            return False
        return True

    def can_transform_error(self, target: str, source: str, stamp_ns: int) -> str | None:
        """Return the text of tf2's canTransform, or None if the transform is available."""
        return self._tree.can_transform_error(target, source, stamp_ns)

    def latest_common_time(self, target: str, source: str) -> int:
        """Return the newest time at which every link between the frames has data, as in tf2.

        Returns:
            Nanoseconds; 0 if all links are static.

        Raises:
            TransformException: as `lookup`, except for extrapolation.
        """
        self._tree.validate("get_latest_common_time", target)
        self._tree.validate("get_latest_common_time", source)
        return self._tree.latest_common_time(target, source)

    def clear(self) -> None:
        """Forget the samples of moving frames; as in tf2 frames and static transforms stay."""
        for cache in self._tree.caches.values():
            cache.clear()
        self.refusals.clear()
        self._room_made_ns = NEVER_NS
        self.forget_publishers()
        self.version += 1
        self.structure_version += 1

    def forget(self) -> None:
        """Forget all frames, static ones too."""
        self._tree.caches.clear()
        self._tree.names.clear()
        self._publishers.clear()
        self.conflicts.forget()
        self._topology = self._largest = None
        self.clear()

    def forget_publishers(self) -> None:
        """Forget conflicts over frames, such as after publishers came or went."""
        for publishers in self._publishers.values():
            publishers.forget()

    def link(self, frame: str) -> NewestTransform | None:
        """Return the newest transform of a frame to its parent; None for roots and without data."""
        cache = self._tree.caches.get(frame)
        if cache is None or (newest := cache.newest) is None:
            return None
        pose, parent = newest
        return NewestTransform(parent, Transform.of(pose, cache.newest_stamp), cache.is_static)

    def rigid_root(self, frame: str) -> str:
        """Return the uppermost frame that static transforms join with this one, at least itself.

        Frames of one rigid root never move relative to each other. Valid until
        `structure_version` changes.
        """
        return self._tree.rigid_root(frame)

    def who(self, child: str) -> list[str]:
        """Return the recent publishers of a child frame, as far as known, the current one last."""
        publishers = self._publishers.get(child)
        names = publishers.names() if publishers else []
        return [self.nodes.get(name, name) for name in names if name]

    def largest_tree(self) -> tuple[str, int]:
        """Return the root and the number of frames of the largest tree, "" and 0 without any."""
        if self._largest is None or self._largest[0] != self.structure_version:
            sizes = Counter(roots(self._tree).values())
            (largest,) = sizes.most_common(1) or [("", 0)]
            self._largest = (self.structure_version, largest)
        return self._largest[1]

    def all_frames_as_string(self) -> str:
        """One line per child frame, word for word as tf2."""
        return self._tree.as_text()

    def all_frames_as_yaml(self, now_ns: int = 0) -> str:
        """Parent, publisher, rate and age per child frame, word for word as tf2."""
        return frames_as_yaml(self._tree, self._publishers, now_ns)

    def frames(self) -> list[str]:
        """All frame ids ever mentioned, in order of first mention."""
        return list(self._tree.names)

    def _pose(self, target: str, source: str, stamp_ns: int) -> tuple[PoseTuple, int]:
        if target == source:
            return IDENTITY, stamp_ns or self._tree.latest_common_time(target, source)
        self._tree.validate("lookupTransform argument target_frame", target)
        self._tree.validate("lookupTransform argument source_frame", source)
        return self._tree.resolve(target, source, stamp_ns)

    def _topology_of(self, target: str, frames: list[str]) -> Topology:
        key = (self.structure_version, target, frames)
        if self._topology is None or self._topology[0] != key:
            self._topology = (key, Topology(self._tree, target, frames))
        return self._topology[1]

    def _new_cache(self, parent: str, child: str, is_static: bool) -> Cache:
        cache = StaticCache() if is_static else TimeCache(self.cache_time_ns)
        tree = self._tree
        tree.caches[child] = cache
        tree.names.setdefault(child)
        tree.names.setdefault(parent)
        return cache

    def _claim(self, child: str, claim: Claim, authority: str, stamp_ns: int) -> None:
        """Note the publisher of a stored transform."""
        publishers = self._publishers.get(child)
        if publishers is None:
            publishers = self._publishers[child] = Publishers(authority, claim)
        elif publishers.claim != claim:
            horizon_ns = self._tree.caches[child].newest_stamp - self.cache_time_ns
            publishers.take_over(authority, claim, stamp_ns, horizon_ns)
        publishers.current = authority

    def _has_room(self, child: str, stamp_ns: int, received_ns: int) -> bool:
        """Return whether one more frame can be kept, if need be instead of expired ones."""
        tree = self._tree
        if len(tree.names) >= MAX_FRAMES and stamp_ns - self._room_made_ns > NS_PER_S:
            self._room_made_ns = stamp_ns
            for frame in tree.forget_expired(stamp_ns - self.cache_time_ns):
                del self._publishers[frame]
            self.conflicts.forget()
            self.structure_version += 1
        if len(tree.names) < MAX_FRAMES:
            return True
        self.refusals.exceed(child, received_ns)
        return False
