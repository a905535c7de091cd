"""Keeps browsers away for a while whose connections were ended because they sent too much."""

from __future__ import annotations

from collections.abc import Hashable

import msgspec

FIRST_S = 10.0
"""Seconds to stay away after the first time; each further time takes twice as long."""
MAX_S = 320.0
FORGIVEN_S = 600.0
"""Seconds after the end of such a time until the next one counts as the first again."""
MAX_REMEMBERED = 1024


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
