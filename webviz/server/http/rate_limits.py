"""Limits of browsers that connecting again does not lift: rates, and absence after too much."""

from __future__ import annotations

from collections.abc import Hashable

import msgspec

FIRST_S = 10.0
"""Seconds to stay away after the first time; each further time takes twice as long."""
MAX_S = 320.0
FORGIVEN_S = 600.0
"""Seconds after the end of such a time until the next one counts as the first again."""


class _Absence(msgspec.Struct, frozen=True):
    """A time to stay away.

    Args:
        seconds: its length.
        until: its end, in seconds of the event loop's clock.
    """

    seconds: float
    until: float


class BackOff:
    """Remembers who has to stay away, and until when; belongs to the event loop."""

    def __init__(self) -> None:
        self._absences: dict[Hashable, _Absence] = {}

    def send_away(self, sender: Hashable, now: float) -> None:
        """Keep a sender away from now on; several connections that end together count once.

        Args:
            sender: whose connection was ended.
            now: time in seconds.
        """
        before = self._absences.get(sender)
        if before is not None and now < before.until:
            return
        seconds = FIRST_S
        if before is not None and now <= before.until + FORGIVEN_S:
            seconds = min(2.0 * before.seconds, MAX_S)
        self._absences.pop(sender, None)  # the last in the order of the others
        self._absences[sender] = _Absence(seconds, now + seconds)
        if len(self._absences) > MAX_REMEMBERED:
            del self._absences[next(iter(self._absences))]

    def wait_s(self, sender: Hashable, now: float) -> float:
        """Return the seconds until a sender may connect again, 0 if it may now."""
        absence = self._absences.get(sender)
        return 0.0 if absence is None else max(0.0, absence.until - now)


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
        if rate_limit.paid_until <= (times := self._paid_until).get(sender, -float("inf")):
            return
        times[sender] = rate_limit.paid_until
        if len(times) > MAX_REMEMBERED:
            del times[min(times, key=times.__getitem__)]

    def resume(self, sender: Hashable, rate_limit: RateLimit, now: float) -> None:
        """Let the rate_limit of a new connection go on from what its sender has spent."""
        if (paid_until := self._paid_until.get(sender)) is not None:
            rate_limit.resume(paid_until, now)
