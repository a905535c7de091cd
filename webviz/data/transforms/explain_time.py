"""Reasons why a frame has no pose at one time although it has one at others."""

from __future__ import annotations

from dataclasses import replace

from webviz.data.transforms.buffer import TransformBuffer
from webviz.data.transforms.cache import TimeCache
from webviz.data.transforms.diagnosis import STALE_PERIODS
from webviz.data.transforms.errors import NS_PER_S, stamp_to_seconds
from webviz.data.transforms.reasons import HOUR_NS, WALL_NS, YEAR_NS, Explanation, Kind, in_words
from webviz.data.transforms.tree import ancestors

STALE_NS = NS_PER_S
"""Silence in ns after which, and after `STALE_PERIODS` of its periods, a link has stopped; the
slowest usual publisher, AMCL at rest, takes 1 s."""


def explain_time(
    buffer: TransformBuffer, fixed_frame: str, frame: str, stamp_ns: int, now_ns: int, text: str
) -> Explanation:
    """Name the link of the chain without data at the stamp; `text` is tf2's."""
    tree = buffer.tree
    up, down = ancestors(tree, frame), ancestors(tree, fixed_frame)
    shared = set(up) & set(down)
    links: list[tuple[str, TimeCache]] = []
    for name in (*up, *down):
        cache = tree.caches.get(name)
        if name not in shared and isinstance(cache, TimeCache):
            links.append((name, cache))
    empty = [name for name, cache in links if not cache.stamps]
    if empty:
        sentence = f'No transform of "{empty[0]}" has arrived since the transforms were cleared.'
        return Explanation(Kind.NO_DATA, sentence, link=empty[0])
    if stamp_ns == 0:
        alone = [name for name, cache in links if len(cache.stamps) == 1]
        if not alone:
            return _apart(buffer, links, now_ns) or Explanation(Kind.NO_DATA, f"{text}.")
        return Explanation(
            Kind.NO_DATA,
            f"Only one transform {_link(buffer, alone[0])} has arrived, newer than others "
            "in the chain; a second one is needed.",
            link=alone[0],
        )
    late = [(cache.stamps[-1], name) for name, cache in links if cache.stamps[-1] < stamp_ns]
    early = [(cache.stamps[0], name) for name, cache in links if cache.stamps[0] > stamp_ns]
    if late:
        newest, child = min(late)
        return replace(_ahead(buffer, child, stamp_ns, newest, now_ns), link=child)
    if early:
        oldest, child = max(early)
        cache = tree.caches[child]
        reason = _behind(buffer, child, stamp_ns, oldest, cache.newest_stamp)
        return replace(reason, link=child)
    return Explanation(Kind.NO_DATA, f"{text}.")


def _apart(
    buffer: TransformBuffer, links: list[tuple[str, TimeCache]], now_ns: int
) -> Explanation | None:
    """Name a link that stopped so long ago that others have forgotten its last time."""
    newest_ns, child = min((cache.stamps[-1], name) for name, cache in links)
    oldest_ns, other = max((cache.stamps[0], name) for name, cache in links)
    age_ns = now_ns - newest_ns
    if not STALE_NS < oldest_ns - newest_ns < HOUR_NS or age_ns < STALE_NS or oldest_ns > now_ns:
        return None  # not known to have stopped; others may come from the future
    return Explanation(
        Kind.NO_DATA,
        f"The transform {_link(buffer, child)} has stopped: its last is {in_words(age_ns)} old, "
        f"older than all that are kept of {_link(buffer, other)}. Restart its publisher.",
        link=child,
    )


def _link(buffer: TransformBuffer, child: str) -> str:
    newest = buffer.tree.caches[child].newest
    parent = newest[1] if newest else "?"
    publishers = buffer.who(child)
    who = f" (from {publishers[-1]})" if publishers else ""
    return f'"{parent}" → "{child}"{who}'


def _clocks(buffer: TransformBuffer, child: str, stamp_ns: int, tf_ns: int) -> Explanation | None:
    """Stamps that cannot come from one clock."""
    gap = abs(stamp_ns - tf_ns)
    if gap < HOUR_NS:
        return None
    stamp, tf = f"{stamp_to_seconds(stamp_ns):.1f} s", f"{stamp_to_seconds(tf_ns):.1f} s"
    for ns, other, simulated, real in (
        (stamp_ns, tf_ns, f"data ({stamp})", f'transform of "{child}" ({tf})'),
        (tf_ns, stamp_ns, f'transform of "{child}" ({tf})', f"data ({stamp})"),
    ):
        if ns < YEAR_NS and other > WALL_NS:
            return Explanation(
                Kind.CLOCKS,
                f"Two clocks: the {simulated} is stamped with simulated time or time since boot, "
                f"the {real} with wall time. Set use_sim_time alike on all nodes (true with a "
                "simulator or a bag played with --clock).",
            )
    return Explanation(
        Kind.CLOCKS,
        f'The stamps of the data ({stamp}) and of the transform of "{child}" ({tf}) are '
        f"{in_words(gap)} apart: synchronise the clocks of the machines, or play the bag with "
        "--clock and set use_sim_time.",
    )


def _ahead(
    buffer: TransformBuffer, child: str, stamp_ns: int, newest_ns: int, now_ns: int
) -> Explanation:
    clocks = _clocks(buffer, child, stamp_ns, newest_ns)
    if clocks:
        return clocks
    link = _link(buffer, child)
    lag = stamp_ns - newest_ns
    text = f"The stamp is {in_words(lag)} ahead of the newest transform {link}"
    age = now_ns - newest_ns
    if now_ns and stamp_ns - now_ns > STALE_NS:
        return Explanation(
            Kind.AHEAD,
            f"{text}; it is even {in_words(stamp_ns - now_ns)} ahead of the present: the clock of "
            "the data's publisher is fast, synchronise the clocks of the machines.",
            lag,
        )
    cache = buffer.tree.caches[child]
    delay = cache.delay_ns or 0
    if now_ns and delay > STALE_NS and age - delay < STALE_NS:
        return Explanation(
            Kind.CLOCKS,
            f"{text}, which comes stamped {in_words(delay)} in the past: the clock of its "
            "publisher is slow, or its transforms take long. Synchronise the machines' clocks.",
            lag,
        )
    period = (newest_ns - cache.oldest_stamp) // max(1, len(cache) - 1)
    if now_ns and age > STALE_NS and len(cache) == 1:
        return Explanation(
            Kind.AHEAD,
            f"{text}, of which only one has arrived, {in_words(age)} ago. Check its publisher.",
            lag,
        )
    if now_ns and age > max(STALE_NS, STALE_PERIODS * period):
        return Explanation(
            Kind.AHEAD,
            f"{text}, which has stopped: its last is {in_words(age)} old. Restart its publisher.",
            lag,
        )
    aged = f", which is {in_words(age)} old" if now_ns and age > 0 else ""
    return Explanation(
        Kind.AHEAD,
        f"{text}{aged}: the message waits for that link to catch up.",
        lag,
        is_catching_up=True,
    )


def _behind(
    buffer: TransformBuffer, child: str, stamp_ns: int, oldest_ns: int, newest_ns: int
) -> Explanation:
    clocks = _clocks(buffer, child, stamp_ns, oldest_ns)
    if clocks:
        return clocks
    link = _link(buffer, child)
    rejection = buffer.refusals.rejections.get(child)
    is_recent = rejection and abs(rejection.stamp_ns - stamp_ns) < buffer.cache_time_ns
    if rejection and rejection.reason == "TF_OLD_DATA" and is_recent:
        return Explanation(
            Kind.JUMPED_BACK,
            f"Time jumped back: the stamp is {in_words(newest_ns - stamp_ns)} older than the "
            f"newest transform {link}, and {rejection.count} older transforms were refused. If a "
            "bag started again, press Reset.",
        )
    text = (
        f"The stamp is {in_words(oldest_ns - stamp_ns)} older than the oldest transform kept of "
        f"{link}"
    )
    span_ns = newest_ns - oldest_ns
    if span_ns < buffer.cache_time_ns // 2:
        return Explanation(
            Kind.BEHIND, f"{text}, which began only {in_words(span_ns)} ago: newer data will show."
        )
    return Explanation(
        Kind.BEHIND,
        f"{text}; {in_words(buffer.cache_time_ns)} are kept. The data arrives too late: look for "
        "a slow node or network, or increase the TF cache time.",
    )
