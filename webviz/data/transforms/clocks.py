"""Agreement between the clocks of the publishers of transforms and ours."""

from __future__ import annotations

import itertools
from collections.abc import Mapping

from webviz.data.transforms.buffer import TransformBuffer
from webviz.data.transforms.cache import StaticCache, TimeCache
from webviz.data.transforms.errors import NS_PER_S
from webviz.data.transforms.reasons import HOUR_NS, WALL_NS, YEAR_NS, in_words
from webviz.data.transforms.tree import ancestors
from webviz.data.words import Problem

TOLERANCE_NS = 1_500_000_000
"""Tolerated offset: AMCL stamps its transform up to 1 s ahead (its transform_tolerance)."""
RECENT_NS = 10 * NS_PER_S
MAX_NAMES = 3


def clock_problem(
    buffer: TransformBuffer, now_ns: int, is_recorded: bool = False
) -> Problem | None:
    """Return which transforms have stamps that differ from our time, and by how much.

    Args:
        buffer: transforms inserted with the time at which they were received.
        now_ns: the current ROS time; 0 if unknown.
        is_recorded: whether they are of a bag, whose time cannot be chosen.

    Returns:
        None if the clocks agree.
    """
    offsets = _offsets(buffer, now_ns)
    wrong = {child: ns for child, ns in offsets.items() if abs(ns) > TOLERANCE_NS}
    if not now_ns or not wrong:
        return None
    child, worst = max(wrong.items(), key=lambda item: abs(item[1]))
    if is_recorded:
        side = "ahead of" if worst > 0 else "behind"
        return Problem(
            f'"{child}" is stamped {in_words(worst)} {side} the time of the bag.',
            "Synchronise the clocks of the machines before you record again.",
        )
    stamp_ns = buffer.tree.caches[child].newest_stamp
    if stamp_ns < YEAR_NS and now_ns > WALL_NS:
        return Problem(
            f'"{child}" is stamped with simulated time ({stamp_ns / NS_PER_S:.1f} s), but webviz '
            "follows the clock of this computer.",
            "Start webviz with --ros-args -p use_sim_time:=true.",
        )
    offset = f"{in_words(worst)} {'ahead of' if worst > 0 else 'behind'}"
    if len(wrong) == len(offsets) and abs(worst) > HOUR_NS:
        return Problem(
            f"The transforms are stamped {offset} the time of this computer, as those of a "
            "replayed bag are.",
            "To follow its time, play it with --clock and start webviz with --ros-args -p "
            "use_sim_time:=true.",
        )
    names = [f'"{child}"' for child in wrong]
    names_text = ", ".join(names[:MAX_NAMES]) + (" …" if len(names) > MAX_NAMES else "")
    who = "All transforms" if len(wrong) == len(offsets) else f"The transforms of {names_text}"
    rest = "" if len(wrong) == len(offsets) else ", the others are not"
    return Problem(
        f"{who} are stamped {offset} the clock of this computer{rest}.",
        "Synchronise the clocks of the machines (chrony, NTP).",
    )


def is_off(buffer: TransformBuffer, frame: str, now_ns: int) -> bool:
    """Return whether a transform between a frame and its root is seconds or minutes off.

    Beyond an hour, the two clocks are of different kinds.

    Args:
        buffer: transforms inserted with the time at which they were received.
        frame: its name.
        now_ns: the current ROS time.
    """
    offsets = _offsets(buffer, now_ns)
    chain = ancestors(buffer.tree, frame)
    return any(TOLERANCE_NS < abs(offsets.get(each, 0)) < HOUR_NS for each in chain)


def _offsets(buffer: TransformBuffer, now_ns: int) -> Mapping[str, int]:
    """Return stamps minus times of reception in nanoseconds, by child, of recent transforms."""
    offsets: dict[str, int] = {}
    for child, cache in buffer.tree.caches.items():
        # A single transform may be its last, repeated where a slice of a recording begins.
        if not isinstance(cache, TimeCache) or not cache or cache.is_single:
            continue
        if (delay_ns := cache.delay_ns) is None:
            continue
        if now_ns - (cache.newest_stamp + delay_ns) < RECENT_NS:
            offsets[child] = -delay_ns
    return offsets


def receptions(buffer: TransformBuffer) -> Mapping[int, int]:
    """Return when the newest stamps of moving frames were first received, by stamp.

    Both in nanoseconds; stamps whose reception is unknown are left out.
    """
    caches = (each for each in buffer.tree.caches.values() if isinstance(each, TimeCache))
    return {each.newest_stamp: seen_ns for each in caches if (seen_ns := each.seen_ns)}


def received_ns(buffer: TransformBuffer, target: str, source: str, stamp_ns: int) -> int:
    """Return when the last transform was received without which a pose at a time is unknown.

    All times are ROS time in nanoseconds.

    Args:
        buffer: transforms inserted with the time at which they were received.
        target, source: frames.
        stamp_ns: the time of the pose.

    Returns:
        As far as the delay of each link is that of its newest transform; 0 if unknown.
    """
    chains = [ancestors(buffer.tree, frame) for frame in (target, source)]
    latest_ns = 0
    for child in set(chains[0]) ^ set(chains[1]):
        cache = buffer.tree.caches.get(child)
        if isinstance(cache, StaticCache):
            latest_ns = max(latest_ns, cache.seen_ns)
        elif cache and (delay_ns := cache.delay_ns) is not None:
            needed = itertools.takewhile(lambda each: each >= stamp_ns, reversed(cache.stamps))
            first_ns = min(needed, default=0)
            latest_ns = max(latest_ns, first_ns + delay_ns if first_ns else 0)
    return latest_ns
