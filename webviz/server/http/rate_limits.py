"""Rates of messages with bursts, which browsers that connect again do not gain anew."""

from __future__ import annotations

from collections.abc import Hashable

MAX_REMEMBERED = 1024


class RateLimit:
    """A rate limit with bursts.

    Args:
        rate: messages per second.
        burst: messages at once.
    """

    def __init__(self, rate: float, burst: float) -> None:
        self._rate = rate
        self._credit = burst / rate
        self.paid_until = -float("inf")
        """Time in seconds when what was sent will have been paid for by the rate alone."""
        self._in_time = -float("inf")

    def resume(self, paid_until: float, now: float) -> None:
        """Continue with what an earlier connection has spent."""
        self.paid_until, self._in_time = max(self.paid_until, paid_until), now

    def spend(self, messages: float, now: float) -> float:
        """Count messages at a time in seconds; return how many seconds to wait."""
        if now - self.paid_until >= self._credit / 2.0:
            self._in_time = now
        self.paid_until = max(self.paid_until, now - self._credit) + messages / self._rate
        return max(0.0, self.paid_until - now)

    def exhausted_s(self, now: float) -> float:
        """Seconds since the last message at which half a burst or more was left."""
        return now - self._in_time


class SpentRates:
    """Remembers what lost connections have spent, so that connecting again brings no new burst."""

    def __init__(self) -> None:
        self._paid_until: dict[Hashable, float] = {}

    def note(self, sender: Hashable, rate_limit: RateLimit) -> None:
        """Remember what a sender has spent; of too many, what is paid for first is forgotten."""
        if rate_limit.paid_until <= (kept := self._paid_until).get(sender, -float("inf")):
            return
        kept[sender] = rate_limit.paid_until
        if len(kept) > MAX_REMEMBERED:
            del kept[min(kept, key=kept.__getitem__)]

    def resume(self, sender: Hashable, rate_limit: RateLimit, now: float) -> None:
        """Let the rate_limit of a new connection go on from what its sender has spent."""
        if (paid_until := self._paid_until.get(sender)) is not None:
            rate_limit.resume(paid_until, now)
