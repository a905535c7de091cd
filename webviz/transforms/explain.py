"""Why a frame has no pose at a time, in words and numbers, and what to do about it."""

from __future__ import annotations

from dataclasses import dataclass
from difflib import get_close_matches
from enum import StrEnum

from webviz.transforms.buffer import TransformBuffer
from webviz.transforms.cache import TimeCache
from webviz.transforms.errors import (
    NS_PER_S,
    ConnectivityException,
    LookupException,
    TransformException,
    stamp_to_seconds,
)
from webviz.transforms.tree import FrameTree

YEAR_NS = 365 * 86_400 * NS_PER_S
"""Simulated time and time since boot start at 0: below a year it cannot be the wall clock."""

WALL_NS = 1_000_000_000 * NS_PER_S
"""Wall time, counted since 1970, has been beyond this since September 2001."""

HOUR_NS = 3600 * NS_PER_S
STALE_NS = NS_PER_S
"""A link silent for so long has stopped; the slowest usual publisher, AMCL at rest, takes 1 s."""


class Kind(StrEnum):
    """What keeps a frame from having a pose."""

    AVAILABLE = "available"
    EMPTY_FRAME = "empty frame_id"
    LEADING_SLASH = "leading slash"
    NO_TRANSFORMS = "no transforms at all"
    UNKNOWN_FRAME = "frame never seen"
    UNKNOWN_FIXED_FRAME = "fixed frame never seen"
    NOT_CONNECTED = "two trees"
    LOOP = "loop"
    AHEAD = "stamp ahead of the transforms"
    BEHIND = "stamp older than the transforms"
    CLOCKS = "clocks disagree"
    JUMPED_BACK = "time jumped back"
    NO_DATA = "too little data"
    QUEUE_FULL = "queue full"


@dataclass(frozen=True)
class Explanation:
    """One reason.

    Attributes:
        kind: which of the known reasons.
        sentence: what is wrong, with numbers, and what to do next.
        lag_ns: by how much the transforms are behind the stamp, if they are.
        is_catching_up: the transforms are behind, but still come.
    """

    kind: Kind
    sentence: str
    lag_ns: int = 0
    is_catching_up: bool = False


def explain(
    buffer: TransformBuffer, fixed_frame: str, frame: str, stamp_ns: int, now_ns: int = 0
) -> Explanation:
    """Say why `frame` has no pose in `fixed_frame` at a stamp.

    Args:
        buffer: the transforms.
        fixed_frame: frame that everything is shown in.
        frame: frame of the data.
        stamp_ns: time of the data; 0 means the latest.
        now_ns: the current ROS time, 0 if it is not known.
    """
    if frame == fixed_frame and frame:
        return Explanation(Kind.AVAILABLE, "Transform OK")
    faulty = _invalid(buffer, fixed_frame, frame)
    if faulty:
        return faulty
    tree = buffer.tree
    try:
        tree.resolve(fixed_frame, frame, stamp_ns)
    except LookupException:
        return _loop(tree, fixed_frame, frame)
    except ConnectivityException:
        return _not_connected(tree, fixed_frame, frame)
    except TransformException as error:
        return _extrapolation(buffer, fixed_frame, frame, stamp_ns, now_ns, str(error))
    return Explanation(Kind.AVAILABLE, "Transform OK")


def ancestors(tree: FrameTree, frame: str) -> list[str]:
    """The frame and what is above it now, up to the root or until a loop closes."""
    chain: list[str] = []
    while frame not in chain:
        chain.append(frame)
        cache = tree.caches.get(frame)
        if cache is None or cache.newest is None:
            return chain
        frame = cache.newest[1]
    return [*chain, frame]


def in_words(duration_ns: int) -> str:
    """A duration in the unit that people would use."""
    size = abs(duration_ns)
    for limit, unit, digits, name in (
        (10_000_000, 1_000_000, 1, "ms"),
        (NS_PER_S, 1_000_000, 0, "ms"),
        (120 * NS_PER_S, NS_PER_S, 1, "s"),
        (2 * HOUR_NS, 60 * NS_PER_S, 0, "min"),
        (48 * HOUR_NS, HOUR_NS, 1, "hours"),
        (2 * YEAR_NS, 24 * HOUR_NS, 0, "days"),
    ):
        if size < limit:
            return f"{size / unit:.{digits}f} {name}"
    return f"{size / YEAR_NS:.0f} years"


def _invalid(buffer: TransformBuffer, fixed_frame: str, frame: str) -> Explanation | None:
    """What is wrong with the names alone."""
    if not frame:
        return Explanation(
            Kind.EMPTY_FRAME,
            "The frame_id is empty: the publisher has to name the frame its data is given in "
            "(header.frame_id).",
        )
    if not fixed_frame:
        return Explanation(Kind.EMPTY_FRAME, "There is no fixed frame: choose one.")
    for name, what in ((frame, "The frame_id"), (fixed_frame, "The fixed frame")):
        if name[0] == "/":
            return Explanation(
                Kind.LEADING_SLASH,
                f'{what} "{name}" starts with a slash, which frame ids in ROS 2 must not: '
                f'call it "{name.lstrip("/")}".',
            )
    names = buffer.tree.names
    if not names:
        return Explanation(
            Kind.NO_TRANSFORMS,
            f'There is no transform at all, so "{frame}" has no place in "{fixed_frame}": is '
            "anything publishing on /tf or /tf_static (robot_state_publisher, odometry, "
            "localisation)?",
        )
    if fixed_frame not in names:
        return Explanation(
            Kind.UNKNOWN_FIXED_FRAME,
            f'The fixed frame "{fixed_frame}" was never seen in a transform; '
            f"{_nearest(buffer, fixed_frame)}: choose another, or start what publishes it.",
        )
    if frame not in names:
        return Explanation(
            Kind.UNKNOWN_FRAME,
            f'The frame "{frame}" was never seen in a transform; {_nearest(buffer, frame)}: '
            "correct the publisher's frame_id, or publish a transform to this frame.",
        )
    return None


def _nearest(buffer: TransformBuffer, name: str) -> str:
    known = buffer.frames()
    by_lower_case = {frame.lower(): frame for frame in known}
    near = get_close_matches(name.lower(), list(by_lower_case), 1, 0.5)
    if near:
        return f'the nearest name is "{by_lower_case[near[0]]}"'
    tails = [frame for frame in known if frame.split("/")[-1] == name.split("/")[-1]]
    if tails:
        return f'the nearest name is "{tails[0]}"'
    shown = ", ".join(known[:4]) + (" …" if len(known) > 4 else "")
    return f"known are {shown}"


def _loop(tree: FrameTree, fixed_frame: str, frame: str) -> Explanation:
    for start in (frame, fixed_frame):
        chain = ancestors(tree, start)
        if chain[-1] in chain[:-1]:
            loop = " → ".join(chain[chain.index(chain[-1]) :])
            return Explanation(
                Kind.LOOP,
                f"The frames form a loop, each the child of the next: {loop}. Two publishers "
                "disagree about who is whose parent: stop one of them.",
            )
    return Explanation(Kind.LOOP, "The frames formed a loop at that time.")


def _not_connected(tree: FrameTree, fixed_frame: str, frame: str) -> Explanation:
    root, fixed_root = ancestors(tree, frame)[-1], ancestors(tree, fixed_frame)[-1]
    if root == fixed_root:
        return Explanation(
            Kind.NOT_CONNECTED,
            f'At that time nothing connected "{frame}" with "{fixed_frame}"; now it does.',
        )
    for top in (root, fixed_root):
        if top in tree.caches:
            return Explanation(
                Kind.NO_DATA,
                f'No transform of "{top}" has come since the transforms were cleared, so '
                f'"{frame}" is not connected with "{fixed_frame}".',
            )
    hint = ""
    if fixed_root == "map":
        hint = " Is localisation (AMCL, SLAM) running and initialised?"
    return Explanation(
        Kind.NOT_CONNECTED,
        f'"{frame}" and "{fixed_frame}" are in two trees that no transform connects: one has the '
        f'root "{root}", the other "{fixed_root}". Publish a transform from one to the other, or '
        f"choose a fixed frame in the first.{hint}",
    )


def _extrapolation(
    buffer: TransformBuffer, fixed_frame: str, frame: str, stamp_ns: int, now_ns: int, text: str
) -> Explanation:
    """Name the link of the chain that has no data at the stamp."""
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
        sentence = f'No transform of "{empty[0]}" has come since the transforms were cleared.'
        return Explanation(Kind.NO_DATA, sentence)
    late = [(cache.stamps[-1], name) for name, cache in links if cache.stamps[-1] < stamp_ns]
    early = [(cache.stamps[0], name) for name, cache in links if cache.stamps[0] > stamp_ns]
    if late and (not early or stamp_ns != 0):
        newest, child = min(late)
        return _ahead(buffer, child, stamp_ns, newest, now_ns)
    if early:
        oldest, child = max(early)
        cache = tree.caches[child]
        return _behind(buffer, child, stamp_ns, oldest, cache.newest_stamp)
    return Explanation(Kind.NO_DATA, f"{text}.")


def _link(buffer: TransformBuffer, child: str) -> str:
    newest = buffer.tree.caches[child].newest
    parent = newest[1] if newest else "?"
    publishers = buffer.publishers.get(child)
    who = f" (from {publishers.current})" if publishers and publishers.current else ""
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
            "the data's publisher is fast.",
            lag,
            is_catching_up=True,
        )
    if now_ns and age > STALE_NS:
        return Explanation(
            Kind.AHEAD,
            f"{text}, which has stopped: its last is {in_words(age)} old. Is its publisher still "
            "running?",
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
    rejection = buffer.rejections.get(child)
    if rejection and rejection.reason == "TF_OLD_DATA":
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
    kept = newest_ns - oldest_ns
    if kept < buffer.cache_time_ns // 2:
        return Explanation(
            Kind.BEHIND, f"{text}, which began only {in_words(kept)} ago: newer data will show."
        )
    return Explanation(
        Kind.BEHIND,
        f"{text}; {in_words(buffer.cache_time_ns)} are kept. The data comes too late: look for "
        "a slow node or network before it, or raise the TF cache time.",
    )
