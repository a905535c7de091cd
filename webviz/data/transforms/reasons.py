"""Reasons why a frame has no pose, and durations in words."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from enum import StrEnum

from webviz.data.transforms.errors import NS_PER_S

HOUR_NS = 3600 * NS_PER_S
YEAR_NS = 365 * 24 * HOUR_NS

WALL_NS = 1_000_000_000 * NS_PER_S
"""Wall time, counted since 1970, has been beyond this since September 2001.

Simulated time and time since boot start at 0: below a year it cannot be the wall clock.
"""


class Kind(StrEnum):
    """Reason why a frame has no pose."""

    AVAILABLE = "available"
    EMPTY_FRAME = "empty frame_id"
    LEADING_SLASH = "leading slash"
    NO_TRANSFORMS = "no transforms at all"
    REFUSED = "transform refused"
    UNKNOWN_FRAME = "frame never seen"
    UNKNOWN_FIXED_FRAME = "fixed frame never seen"
    NOT_CONNECTED = "two trees"
    LOOP = "loop"
    AHEAD = "stamp ahead of the transforms"
    BEHIND = "stamp older than the transforms"
    CLOCKS = "clocks disagree"
    JUMPED_BACK = "time jumped back"
    NO_DATA = "too little data"
    OUT_OF_REACH = "too far away"
    QUEUE_FULL = "queue full"


@dataclass(frozen=True)
class Explanation:
    """One reason.

    Attributes:
        kind: which of the known reasons.
        sentence: the cause with numbers, then the remedy.
        lag_ns: by how much the transforms are behind the stamp, if they are.
        is_catching_up: the transforms are behind, but still arriving.
        cause: what is missing, equal for all frames that lack it; "" for this frame alone.
        roots: of two trees that are not connected, the frame's and the fixed frame's.
        filter_size: of a queue that would be long enough, 0 if it is unknown.
        other_frame: a fixed frame in which the frame has a pose, "" if the sentence names none.
        frame: the one without a pose.
        near: a known frame whose name is similar, "" if the name is not misspelt.
        link: the child frame of the transform that is missing, late or wrong; "" if it is unknown.
        joint: of the robot description that moves the frame, "" for none.
    """

    kind: Kind
    sentence: str
    lag_ns: int = 0
    is_catching_up: bool = False
    cause: str = ""
    roots: tuple[str, str] | None = None
    filter_size: int = 0
    other_frame: str = ""
    frame: str = field(default="", compare=False)
    near: str = field(default="", compare=False)
    link: str = field(default="", compare=False)
    joint: str = field(default="", compare=False)


FOR_ALL = (Kind.NO_TRANSFORMS, Kind.UNKNOWN_FIXED_FRAME)
"""Reasons that do not depend on a single frame."""
MAX_TRIED = 20
MAX_LISTED = 10


def distinct(
    frames: Sequence[str], explain: Callable[[str], Explanation], most: int
) -> dict[str, Explanation]:
    """Return why frames have no pose: one reason per cause, by its first frame.

    Args:
        frames: ids.
        explain: the reason of one frame.
        most: maximum number of reasons.
    """
    by_cause: dict[tuple[Kind, object], tuple[str, Explanation]] = {}
    for frame in frames[:MAX_TRIED]:
        reason = explain(frame)
        if reason.kind in FOR_ALL:
            return {frame: reason}
        by_cause.setdefault((reason.kind, reason.roots or reason.cause or frame), (frame, reason))
    return dict(list(by_cause.values())[:most])


def listed(frames: Sequence[str], link: str = ", ") -> str:
    """Return the first frames by name; the number of the others."""
    more = len(frames) - MAX_LISTED
    return link.join(frames) if more <= 0 else f"{link.join(frames[:MAX_LISTED])} and {more} more"


def in_words(duration_ns: int) -> str:
    """Return a duration in a suitable unit, with few digits so that it changes seldom."""
    size = abs(duration_ns)
    for limit, unit, digits, name in (
        (10_000_000, 1_000_000, 1, "ms"),
        (NS_PER_S, 1_000_000, 0, "ms"),
        (10 * NS_PER_S, NS_PER_S, 1, "s"),
        (120 * NS_PER_S, NS_PER_S, 0, "s"),
        (2 * HOUR_NS, 60 * NS_PER_S, 0, "min"),
        (48 * HOUR_NS, HOUR_NS, 1, "hours"),
        (2 * YEAR_NS, 24 * HOUR_NS, 0, "days"),
    ):
        if size < limit:
            return f"{size / unit:.{digits}f} {name}"
    return f"{size / YEAR_NS:.0f} years"
