"""The pace of the frame loop."""

from __future__ import annotations


class FramePacing:
    """Spaces turns, so that there is one per period on average.

    After a rest two may follow at once: what arrives right after a turn does not wait.
    """

    def __init__(self) -> None:
        self._due = 0.0

    def begin(self, now: float, period: float) -> None:
        """Note the beginning of a turn.

        Args:
            now: monotonic time in seconds.
            period: of turns, in seconds.
        """
        self._due = max(self._due, now - period) + period

    def rest(self, now: float) -> float:
        """Return the seconds until the next turn may begin."""
        return max(0.0, self._due - now)
