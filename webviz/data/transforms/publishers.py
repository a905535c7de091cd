"""The publishers of a frame's transforms, and conflicts between them."""

from __future__ import annotations

import msgspec

from webviz.data.transforms.cache import ParentedPose

Claim = str | ParentedPose
"""Key that distinguishes publishers of one frame: the authority of a moving transform, the parent
and pose of a static one, as publishers of the same static transform agree."""

MAX_REPLACED = 8
"""Claims remembered per frame."""


class Contest(msgspec.Struct, frozen=True):
    """Two alternating claims to one frame.

    Attributes:
        claims: the two.
        stamp_ns: of the transform by which the first of them returned.
    """

    claims: tuple[Claim, Claim]
    stamp_ns: int

    @property
    def is_static(self) -> bool:
        """Return whether a static transform takes part: as they do not repeat, it cannot expire."""
        return not all(isinstance(claim, str) for claim in self.claims)

    def parents(self) -> list[str]:
        """Parents of the static transforms that take part, each once."""
        return list(dict.fromkeys(claim[1] for claim in self.claims if isinstance(claim, tuple)))


class Publishers:
    """The publishers of one child frame, as far as they can be distinguished.

    A publisher that replaces another for good is a restart or a remounted sensor; one that returns
    after it was replaced is a second publisher.

    Attributes:
        current: the authority of the last transform stored.
        claim: what it claimed.
        contest: the last two that alternated, or None.
        changes: how often a static transform replaced another claim, or was replaced, without a
            known contest. The next query of the publishers shows whether it was a restart.
    """

    __slots__ = ("_replaced", "changes", "claim", "contest", "current")

    def __init__(self, authority: str, claim: Claim) -> None:
        self.current = authority
        self.claim = claim
        self.contest: Contest | None = None
        self.changes = 0
        self._replaced: dict[Claim, tuple[str, int]] = {}

    def take_over(self, authority: str, claim: Claim, stamp_ns: int, horizon_ns: int) -> None:
        """Record a claim other than the current one.

        Args:
            authority: its publisher.
            claim: the claim.
            stamp_ns: of its transform.
            horizon_ns: authorities without transforms since this stamp are forgotten.
        """
        if self.contest is None and not (isinstance(claim, str) and isinstance(self.claim, str)):
            self.changes += 1
        self._replaced[self.claim] = (self.current, stamp_ns)
        remaining = {
            old: (who, at)
            for old, (who, at) in self._replaced.items()
            if at > horizon_ns or not isinstance(old, str)
        }
        if claim in remaining:
            del remaining[claim]
            self.contest = Contest((self.claim, claim), stamp_ns)
        self._replaced = dict(list(remaining.items())[-MAX_REPLACED:])
        self.claim, self.current = claim, authority

    def forget(self) -> None:
        """Forget all but the current claim."""
        self.contest = None
        self._replaced.clear()

    def contested(self, newest_ns: int, cache_time_ns: int) -> Contest | None:
        """Return the contest, unless it is between moving transforms and older than the cache time.

        Args:
            newest_ns: newest stamp of the frame.
            cache_time_ns: history kept of moving frames.
        """
        contest = self.contest
        if contest is None or contest.is_static or newest_ns - contest.stamp_ns <= cache_time_ns:
            return contest
        return None

    def names(self) -> list[str]:
        """Return the recent authorities, the current one last."""
        others = dict.fromkeys(who for who, _ in self._replaced.values() if who != self.current)
        return [*others, self.current]
