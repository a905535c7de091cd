"""Past messages that the trail at a time consists of.

A pose is kept if the robot moved since the last one that was kept, so that the trail depends on all
messages before. But trails that begin at different messages soon meet: once they keep the same
pose, they keep the same ones from then on. Reading backwards, it is known that all trails have met
when a single message is left that may be the last one kept.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence

import msgspec

from webviz.data import messages
from webviz_displays.odometry.poses import TrailPlace, fault, has_moved, place_of

MAX_READ = 3000
"""Messages that are read: one to two minutes. Of a robot that rests for longer, the trail begins
there after a seek."""
FIRST_READ = 250
MAX_CANDIDATES = 60
"""Of a robot at rest, every message may be the first of a trail: it is skipped."""


class TrailRule(msgspec.Struct, frozen=True):
    """The poses that are kept.

    Args:
        distance: metres from the last one.
        angle: radians from the last one.
        with_covariance: whether a pose is kept also if its covariance becomes invalid, or valid.
    """

    distance: float
    angle: float
    with_covariance: bool

    def place_of(self, message: messages.Odometry) -> TrailPlace:
        """Return the place of a pose."""
        return place_of(message, with_covariance=self.with_covariance)

    def keeps(self, new: TrailPlace, last: TrailPlace) -> bool:
        """Return whether a pose is kept after the last one."""
        return new.is_sound != last.is_sound or has_moved(new, last, self.distance, self.angle)

    def is_far(self, new: TrailPlace, other: TrailPlace) -> bool:
        """Return whether a pose is kept after all that are not kept after the other one."""
        return has_moved(new, other, 2 * self.distance, 2 * self.angle)


def kept_poses(
    newest_first: Iterator[messages.Odometry], keep: int, rule: TrailRule
) -> Sequence[int]:
    """Return the past messages that are the poses of the trail.

    Args:
        newest_first: past messages.
        keep: number of newest poses; 0 is unlimited.
        rule: of the trail.

    Returns:
        Their numbers, 0 for the newest message, at least as many as there are to keep. Of older
        messages, which trails may not have in common, all: the first without a transform is none
        of the trail.
    """
    places: list[TrailPlace | None] = []
    for size in _sizes():
        for message in itertools.islice(newest_first, size - len(places)):
            places.append(None if fault(message) else rule.place_of(message))
        met = _met(places, rule) or 0
        kept = _kept(places[:met], rule)
        if 0 < keep <= len(kept):
            return kept
        if len(places) < size:
            return [*range(len(places) - 1, met - 1, -1), *kept]
    return _kept(places, rule)


def _sizes() -> Iterator[int]:
    size = FIRST_READ
    while size < MAX_READ:
        yield size
        size *= 2
    yield MAX_READ


def _met(newest_first: Sequence[TrailPlace | None], rule: TrailRule) -> int | None:
    """Return the number of newest places that every trail has, None if there are none."""
    first: TrailPlace | None = None
    is_older_possible = True
    """True while the last place that was kept may be one before the first."""
    candidates: list[tuple[int, TrailPlace]] = []
    """Those that may be the last one that was kept."""
    for number, place in _oldest_first(newest_first):
        if first is None:
            first = place
        elif rule.is_far(place, first):
            is_older_possible = False
        staying = [each for each in candidates if not rule.keeps(place, each[1])]
        if is_older_possible or len(staying) < len(candidates):
            staying.append((number, place))
        candidates = staying
        if len(candidates) == 1 and not is_older_possible:
            return candidates[0][0] + 1
        if len(candidates) > MAX_CANDIDATES:
            first, is_older_possible, candidates = None, True, []
    return None


def _kept(newest_first: Sequence[TrailPlace | None], rule: TrailRule) -> Sequence[int]:
    """Return the numbers of the places of the trail that begins with the oldest."""
    last: TrailPlace | None = None
    found: list[int] = []
    for number, place in _oldest_first(newest_first):
        if last is None or rule.keeps(place, last):
            last = place
            found.append(number)
    return found


def _oldest_first(places: Sequence[TrailPlace | None]) -> Iterator[tuple[int, TrailPlace]]:
    for number in range(len(places) - 1, -1, -1):
        if (place := places[number]) is not None:
            yield number, place
