"""Signs that a frame has two publishers, even if they cannot be distinguished.

The middleware does not name the publisher of a transform. Two publishers of one frame leave
alternating parents, poses at one stamp, stamps, or poses.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from itertools import islice, pairwise
from math import dist

from webviz.data.transforms.buffer import TransformBuffer
from webviz.data.transforms.cache import ParentedPose, TimeCache
from webviz.data.transforms.publishers import Contest

RECENT = 100
"""Newest samples searched."""
MIN_TURNS = 6
"""Consecutive changes of pose, each back to the pose before the last, that mean two publishers."""
LEAP = 10.0
"""Ratio between each step of a turn and the distance of both steps together."""
MIN_LEAP_M = 0.01
"""Smaller changes are noise, such as an encoder's last digit."""


def conflicts(buffer: TransformBuffer, frame: str) -> Iterator[str]:
    """Sentences, one for each sign of two publishers of a child frame."""
    cache = buffer.tree.caches[frame]
    contest = buffer.publishers[frame].contested(cache.newest_stamp, buffer.cache_time_ns)
    if contest:
        yield _in_words(frame, contest)
    if not isinstance(cache, TimeCache) or not cache.stamps:
        return
    stamps = list(islice(reversed(cache.stamps), RECENT))
    is_mixed = cache.mixed_ns >= stamps[-1]
    parents = [p for _, p in islice(reversed(cache.samples), RECENT)] if is_mixed else []
    changes = sum(a != b for a, b in pairwise(parents))
    if changes > 1:
        both = " and ".join(f'"{name}"' for name in sorted(set(parents)))
        yield (
            f'"{frame}" changed its parent {changes} times between {both}: two publishers give it '
            "different parents, stop one of them."
        )
        return
    twins = len(stamps) - len(set(stamps))
    if twins > 1:
        yield (
            f'"{frame}" has {twins} pairs of different poses with the same stamp: two publishers, '
            "or one whose clock stands still."
        )
    elif _takes_turns(cache.samples):
        yield f'"{frame}" alternates between two poses: it has two publishers, stop one of them.'


def _in_words(frame: str, contest: Contest) -> str:
    parents = contest.parents()
    statics = [claim[0] for claim in contest.claims if isinstance(claim, tuple)]
    if len(parents) == 2:
        both = " and ".join(f'"{parent}"' for parent in parents)
        return (
            f'"{frame}" has two parents in static transforms, {both}: stop one of their publishers.'
        )
    if len(statics) == 2:
        apart = dist(statics[0][:3], statics[1][:3])
        return (
            f'"{frame}" has two static poses in "{parents[0]}", {apart:.3f} m apart and '
            "perhaps rotated: stop one of their publishers."
        )
    if statics:
        return (
            f'"{frame}" is published on /tf and as a static transform in "{parents[0]}": stop one '
            "of the publishers."
        )
    names = " and ".join(str(claim) or "an unknown node" for claim in contest.claims)
    return f'"{frame}" has two publishers, {names}: stop one of them.'


def _takes_turns(samples: deque[ParentedPose]) -> bool:
    """Return whether the newest poses alternate between two places."""
    newest = [pose[:3] for pose, _ in islice(reversed(samples), MIN_TURNS + 2)]
    if len(newest) < MIN_TURNS + 2:
        return False
    steps = [dist(a, b) for a, b in pairwise(newest)]
    two_steps = [dist(a, b) for a, b in zip(newest, newest[2:], strict=False)]
    return min(steps) > max(LEAP * max(two_steps), MIN_LEAP_M)
