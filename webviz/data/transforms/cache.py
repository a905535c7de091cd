"""The history of one child frame: its samples over time, or its one static pose."""

from __future__ import annotations

from bisect import bisect_right
from collections import deque

import numpy as np
from numpy.typing import NDArray

from webviz.data.transforms.batches import Batches
from webviz.data.transforms.errors import (
    BackwardExtrapolationException,
    ExtrapolationException,
    ForwardExtrapolationException,
    NoDataForExtrapolationException,
    format_stamp,
)
from webviz.data.transforms.geometry import PACKED, PoseTuple, interpolate

# A bound on memory that tf2 lacks: if a publisher's clock stands still, its data never expires.
# 65536 samples are 10 s at 6.5 kHz.
MAX_SAMPLES = 65_536

NEVER_NS = -(1 << 63)
"""Time before every stamp."""

ParentedPose = tuple[PoseTuple, str]
"""A pose and the parent frame it is given in."""

Bracket = tuple[PoseTuple, PoseTuple, float, str]
"""The poses before and after a time, the ratio between them, and their parent frame."""


class StaticCache:
    """The one pose of a frame that holds at any time.

    Attributes:
        delay_ns: from the stamp of the last transform to its reception; None if unknown.
        seen_ns: when this pose was first received; 0 if unknown.
    """

    __slots__ = ("delay_ns", "sample", "seen_ns")
    is_static = True
    newest_stamp = 0
    oldest_stamp = 0

    def __init__(self) -> None:
        self.sample: ParentedPose | None = None
        self.delay_ns: int | None = None
        self.seen_ns = 0

    def __len__(self) -> int:
        return 1

    @property
    def newest(self) -> ParentedPose | None:
        """The sample; None only before the first insert."""
        return self.sample

    @property
    def parent(self) -> str | None:
        """Parent of the sample; None only before the first insert."""
        return self.sample[1] if self.sample else None

    def insert(self, stamp_ns: int, sample: ParentedPose) -> bool:
        """Overwrite the pose; the stamp has no meaning."""
        self.sample = sample
        return True

    def at(self, stamp_ns: int) -> ParentedPose | None:
        """Return the sample, whatever the time."""
        return self.sample

    def bracket(self, stamp_ns: int) -> Bracket | None:
        """Return the sample, whatever the time."""
        if self.sample is None:
            return None
        pose, parent = self.sample
        return pose, pose, 0.0, parent

    def clear(self) -> None:
        """Keep the transform: static ones outlive a cleared buffer."""


class TimeCache:
    """The samples of a moving frame, ascending by stamp.

    Among equal stamps the later arrival counts as newer. `stamps`, `poses` and `parents` are
    parallel, and readers must not change them. They are deques: with each insert an old sample
    goes, and to move the others up in lists took a third of the time of inserting many frames. A
    pose is kept as bytes, a third of the memory of seven floats in a tuple.

    A cache may follow messages of many transforms: it takes its samples from them once its history
    is read, which that of most frames never is.

    Attributes:
        batches: the messages that it follows, None for none.
        place: of its transform in them.
        mixed_ns: the samples newer than this have one parent.
        twin_ns: the newest stamp that more than one sample has had.
    """

    __slots__ = (
        "_cache_time_ns",
        "_cursor",
        "_delay_ns",
        "_joined",
        "_parents",
        "_poses",
        "_seen_ns",
        "_stamps",
        "batches",
        "mixed_ns",
        "place",
        "twin_ns",
    )
    is_static = False

    def __init__(self, cache_time_ns: int) -> None:
        self.batches: Batches | None = None
        self.place = 0
        self.mixed_ns = self.twin_ns = NEVER_NS
        self._stamps: deque[int] = deque()
        self._poses: deque[bytes] = deque()
        self._parents: deque[str] = deque()
        self._joined = self._cursor = 0
        """Messages that had come when it joined them, and when it last took its samples."""
        self._cache_time_ns = cache_time_ns
        self._delay_ns: int | None = None
        self._seen_ns = 0

    def __len__(self) -> int:
        return len(self.stamps)

    def __bool__(self) -> bool:
        return bool(self._stamps)

    @property
    def stamps(self) -> deque[int]:
        """Nanoseconds."""
        self._take()
        return self._stamps

    @property
    def poses(self) -> deque[bytes]:
        """Poses, as `PACKED`."""
        self._take()
        return self._poses

    def translations(self) -> NDArray[np.float64]:
        """Return the translations of all samples, (N, 3) in metres, the oldest first."""
        return np.frombuffer(b"".join(self.poses)).reshape(-1, 7)[:, :3]

    @property
    def parents(self) -> deque[str]:
        """Frame ids."""
        self._take()
        return self._parents

    @property
    def is_single(self) -> bool:
        """True if it has one sample; one that follows has those of two messages at least."""
        return self.batches is None and len(self._stamps) == 1

    @property
    def delay_ns(self) -> int | None:
        """Delay from the stamp of the last transform to its reception; None if unknown."""
        batches = self.batches
        late_ns = batches.delay_ns(self._joined, self.place) if batches is not None else None
        return self._delay_ns if late_ns is None else late_ns

    @delay_ns.setter
    def delay_ns(self, delay_ns: int | None) -> None:
        self._delay_ns = delay_ns

    @property
    def seen_ns(self) -> int:
        """Time at which the newest stamp was first received; 0 if unknown."""
        batches = self.batches
        late_ns = batches.delay_ns(self._joined, self.place) if batches is not None else None
        return self._seen_ns if late_ns is None else self.newest_stamp + late_ns

    @seen_ns.setter
    def seen_ns(self, seen_ns: int) -> None:
        self._seen_ns = seen_ns

    @property
    def newest_stamp(self) -> int:
        """Nanoseconds; 0 if empty."""
        if self.batches is not None:
            return int(self.batches.newest_ns[self.place])
        return self._stamps[-1] if self._stamps else 0

    @property
    def oldest_stamp(self) -> int:
        """Nanoseconds; 0 if empty."""
        return self.stamps[0] if self.stamps else 0

    @property
    def newest(self) -> ParentedPose | None:
        """The sample of the newest stamp, or None if empty."""
        if self.batches is not None:
            x, y, z, qx, qy, qz, qw = self.batches.rows[self.place].tolist()
            return (x, y, z, qx, qy, qz, qw), self._parents[-1]
        return self._sample(-1) if self._stamps else None

    @property
    def parent(self) -> str | None:
        """Parent of the newest sample, or None if empty."""
        return self._parents[-1] if self._parents else None

    def insert(self, stamp_ns: int, sample: ParentedPose) -> bool:
        """Insert in order; an exact duplicate counts as stored but is not kept twice.

        Old samples are pruned before the new one is inserted, measured by the newest stamp so far:
        as in tf2, one old sample can survive a jump forward until the next insert.

        Returns:
            False if the sample is older than the newest by more than the cache time.
        """
        self.leave()
        stamps, (pose, parent) = self._stamps, sample
        if not stamps or stamp_ns > stamps[-1]:
            if stamps and parent != self._parents[-1]:
                self.mixed_ns = stamps[-1]
            self._append(stamp_ns, PACKED.pack(*pose), parent)
            return True
        horizon = self._prune()
        if stamp_ns < horizon:
            return False
        place = bisect_right(stamps, stamp_ns)
        i = place - 1
        while i >= 0 and stamps[i] == stamp_ns:
            if self._sample(i) == sample:
                return True
            i -= 1
        if parent != self._parents[-1]:
            self.mixed_ns = max(self.mixed_ns, stamp_ns)
        if place and stamps[place - 1] == stamp_ns:
            self.twin_ns = max(self.twin_ns, stamp_ns)
        stamps.insert(place, stamp_ns)
        self._poses.insert(place, PACKED.pack(*pose))
        self._parents.insert(place, parent)
        return True

    def follow(self, batches: Batches, place: int) -> None:
        """Take samples from a place in messages, until one is inserted here."""
        self.batches, self.place = batches, place
        self._joined = self._cursor = batches.count
        batches.follow(place, self._stamps[-1])

    def leave(self) -> None:
        """Follow no messages any more."""
        if self.batches is not None:
            self._delay_ns, self._seen_ns = self.delay_ns, self.seen_ns
            self._take()
            self.batches.leave(self.place)
            self.batches = None

    def _take(self) -> None:
        """Take the samples that came since the last time."""
        if self.batches is None or self.batches.count == self._cursor:
            return
        *before, (stamp_ns, pose) = self.batches.since(self._cursor, self.place)
        self._cursor = self.batches.count
        parent = self._parents[-1]
        if before:
            stamps, poses = zip(*before, strict=True)
            self._stamps.extend(stamps)
            self._poses.extend(poses)
            self._parents.extend([parent] * len(before))
        self._append(stamp_ns, pose, parent)

    def _append(self, stamp_ns: int, pose: bytes, parent: str) -> None:
        """`insert` a sample that is newer than all others, with its pose as `PACKED`."""
        if self._stamps:
            self._prune()
        self._stamps.append(stamp_ns)
        self._poses.append(pose)
        self._parents.append(parent)

    def _sample(self, place: int) -> ParentedPose:
        return PACKED.unpack(self._poses[place]), self._parents[place]

    def _prune(self) -> int:
        """Drop what is too old; returns the stamp from which samples are kept."""
        stamps = self._stamps
        horizon = stamps[-1] - self._cache_time_ns
        while stamps[0] < horizon or len(stamps) >= MAX_SAMPLES:
            stamps.popleft()
            self._poses.popleft()
            self._parents.popleft()
        return horizon

    def at(self, stamp_ns: int) -> ParentedPose | None:
        """Return the sample interpolated at a time, 0 for the newest.

        None if `refusal` has a reason.
        """
        bracket = self.bracket(stamp_ns)
        if bracket is None:
            return None
        before, after, ratio, parent = bracket
        return before if after is before else interpolate(before, after, ratio), parent

    def bracket(self, stamp_ns: int) -> Bracket | None:
        """Return the samples that `at` interpolates; the same pose twice if it does not."""
        stamps = self.stamps
        if not stamps:
            return None
        newest = stamps[-1]
        oldest = stamps[0]
        if stamp_ns == newest or stamp_ns == 0:
            pose, parent = self._sample(-1)
            return pose, pose, 0.0, parent
        if stamp_ns == oldest:
            pose, parent = self._sample(0)
            return pose, pose, 0.0, parent
        if not oldest < stamp_ns < newest:
            return None
        i = bisect_right(stamps, stamp_ns)
        pose, parent = self._sample(i - 1)
        after, other = self._sample(i)
        if parent != other:
            return pose, pose, 0.0, parent  # no interpolation across re-parenting
        start = stamps[i - 1]
        return pose, after, float(stamp_ns - start) / float(stamps[i] - start), parent

    def refusal(self, stamp_ns: int) -> tuple[type[ExtrapolationException], str]:
        """Return why `at` returned None: tf2's exception and the start of its text."""
        stamps = self.stamps
        if not stamps:
            return NoDataForExtrapolationException, ""
        requested, newest, oldest = (format_stamp(s) for s in (stamp_ns, stamps[-1], stamps[0]))
        if len(stamps) == 1:
            return NoDataForExtrapolationException, (
                f"Lookup would require extrapolation at time {requested}, "
                f"but only time {newest} is in the buffer"
            )
        if stamp_ns > stamps[-1]:
            return ForwardExtrapolationException, (
                f"Lookup would require extrapolation into the future.  Requested time {requested} "
                f"but the latest data is at time {newest}"
            )
        return BackwardExtrapolationException, (
            f"Lookup would require extrapolation into the past.  Requested time {requested} "
            f"but the earliest data is at time {oldest}"
        )

    def clear(self) -> None:
        """Forget all samples; the frame itself stays known."""
        if self.batches is not None:
            self._cursor = self.batches.count  # not to take what is forgotten
        self.leave()
        self._stamps.clear()
        self._poses.clear()
        self._parents.clear()
        self._seen_ns = 0
        self.mixed_ns = self.twin_ns = NEVER_NS


Cache = StaticCache | TimeCache
