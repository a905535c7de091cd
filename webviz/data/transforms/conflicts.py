"""Signs that a frame has two publishers, even if they cannot be distinguished.

The middleware does not name the publisher of a transform. Two publishers of one frame leave
alternating parents, poses at one stamp, stamps, or poses.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from enum import StrEnum
from itertools import islice, pairwise
from math import dist

import msgspec

from webviz.data.transforms.cache import NEVER_NS, Cache, TimeCache
from webviz.data.transforms.geometry import PACKED
from webviz.data.transforms.publishers import Contest, Publishers
from webviz.data.words import Problem

RECENT = 100
"""Newest samples searched."""
MIN_TURNS = 6
"""Consecutive changes of pose, each back to the pose before the last, that mean two publishers."""
LEAP = 10.0
"""Ratio between each step of a turn and the distance of both steps together."""
MIN_LEAP_M = 0.01
"""Smaller changes are noise, such as an encoder's last digit."""


class ConflictKind(StrEnum):
    """A sign of two publishers of one frame."""

    TWO_PARENTS = "two parents"
    TWO_STATIC_POSES = "two static poses"
    STATIC_AND_MOVING = "static and moving"
    TWO_PUBLISHERS = "two publishers"


class Conflict(msgspec.Struct, frozen=True):
    """One sign.

    Attributes:
        kind: its kind.
        problem: the cause with a remedy.
        parents: of the frame, as far as they are known.
    """

    kind: ConflictKind
    problem: Problem
    parents: tuple[str, ...] = ()


class Conflicts:
    """The conflicts of all frames of a buffer, sought again only where a transform has arrived.

    Args:
        caches: the samples by child frame.
        publishers: by child frame.
        cache_time_ns: history kept of moving frames.
    """

    def __init__(
        self,
        caches: Mapping[str, Cache],
        publishers: Mapping[str, Publishers],
        cache_time_ns: int,
    ) -> None:
        self._caches = caches
        self._publishers = publishers
        self._cache_time_ns = cache_time_ns
        self._cache: dict[str, tuple[object, Sequence[Conflict]]] = {}
        """State in which frames were found, and the conflicts, by frame."""

    def of(self, frame: str) -> Sequence[Conflict]:
        """Return the signs of two publishers of a child frame."""
        cache = self._caches[frame]
        contest = self._publishers[frame].contested(cache.newest_stamp, self._cache_time_ns)
        if isinstance(cache, TimeCache) and not contest and self._is_calm(cache):
            return ()
        state = id(cache), cache.newest_stamp, len(cache), contest
        entry = self._cache.get(frame)
        if entry is None or entry[0] != state:
            entry = self._cache[frame] = state, tuple(_conflicts(frame, cache, contest))
        return entry[1]

    @staticmethod
    def _is_calm(cache: TimeCache) -> bool:
        """Return whether a frame follows messages without any sign, as nearly all do."""
        batches = cache.batches
        if batches is None or cache.mixed_ns != NEVER_NS or cache.twin_ns != NEVER_NS:
            return False
        return not batches.leaps(LEAP, MIN_LEAP_M)[cache.place]

    def all(self) -> Iterator[tuple[str, Conflict]]:
        """All conflicts with their frames."""
        for frame in self._publishers:
            for conflict in self.of(frame):
                yield frame, conflict

    def forget(self) -> None:
        """Forget what was found."""
        self._cache.clear()


def _conflicts(frame: str, cache: Cache, contest: Contest | None) -> Iterator[Conflict]:
    if contest:
        yield _contested(frame, contest)
    if not isinstance(cache, TimeCache) or not cache.stamps:
        return
    oldest = cache.stamps[-min(RECENT, len(cache.stamps))]
    # Nearly all frames have one parent and each stamp once: to look at 100 samples of each of 200
    # frames at 50 Hz took a tenth of the frame loop's time.
    parents = list(islice(reversed(cache.parents), RECENT)) if cache.mixed_ns >= oldest else []
    changes = sum(a != b for a, b in pairwise(parents))
    if changes > 1:
        names = sorted(set(parents))
        both = " and ".join(f'"{name}"' for name in names)
        yield Conflict(
            ConflictKind.TWO_PARENTS,
            Problem(
                f'"{frame}" changed its parent {changes} times between {both}.',
                "Stop one of the two publishers.",
            ),
            tuple(names),
        )
        return
    stamps = list(islice(reversed(cache.stamps), RECENT)) if cache.twin_ns >= oldest else []
    twins = len(stamps) - len(set(stamps))
    if twins > 1:
        yield Conflict(
            ConflictKind.TWO_PUBLISHERS,
            Problem(
                f'"{frame}" has {twins} pairs of different poses with the same stamp.',
                "Stop one of the two publishers. If there is only one, its clock is not running.",
            ),
        )
    elif _takes_turns(cache.poses):
        yield Conflict(
            ConflictKind.TWO_PUBLISHERS,
            Problem(f'"{frame}" alternates between two poses.', "Stop one of the two publishers."),
        )


def _contested(frame: str, contest: Contest) -> Conflict:
    """Return a contest as a conflict."""
    parents = contest.parents()
    statics = [claim[0] for claim in contest.claims if isinstance(claim, tuple)]
    if len(parents) == 2:
        both = " and ".join(f'"{parent}"' for parent in parents)
        kind = ConflictKind.TWO_PARENTS
        cause = f'"{frame}" has two parents in static transforms, {both}.'
    elif len(statics) == 2:
        apart = dist(statics[0][:3], statics[1][:3])
        kind = ConflictKind.TWO_STATIC_POSES
        cause = (
            f'"{frame}" has two static poses in "{parents[0]}", {apart:.3f} m apart and '
            "perhaps rotated."
        )
    elif statics:
        kind = ConflictKind.STATIC_AND_MOVING
        cause = f'"{frame}" is published on /tf and as a static transform in "{parents[0]}".'
    else:
        names = " and ".join(str(claim) or "an unknown node" for claim in contest.claims)
        kind = ConflictKind.TWO_PUBLISHERS
        cause = f'"{frame}" has two publishers, {names}.'
    return Conflict(kind, Problem(cause, "Stop one of the publishers."), tuple(parents))


def _takes_turns(poses: deque[bytes]) -> bool:
    """Return whether the newest poses alternate between two places."""
    if len(poses) < MIN_TURNS + 2:
        return False
    last, other, before = (PACKED.unpack(poses[-place])[:3] for place in (1, 2, 3))
    if dist(last, other) <= max(LEAP * dist(last, before), MIN_LEAP_M):
        return False  # nearly always
    newest = [PACKED.unpack(pose)[:3] for pose in islice(reversed(poses), MIN_TURNS + 2)]
    steps = [dist(a, b) for a, b in pairwise(newest)]
    two_steps = [dist(a, b) for a, b in zip(newest, newest[2:], strict=False)]
    return min(steps) > max(LEAP * max(two_steps), MIN_LEAP_M)
