"""Point budget: shares of displays in the points that browsers draw fast enough."""

from __future__ import annotations

from collections.abc import Callable


class PointBudget:
    """Shares the points that browsers hold among the displays that want some.

    Those that want little get it, and leave the rest to the others, in equal shares. All methods
    belong to the frame loop.

    Args:
        capacity: how many points every connected browser draws fast enough.
    """

    def __init__(self, capacity: Callable[[], int]) -> None:
        self._capacity = capacity
        self._demands: dict[str, int] = {}

    def share(self, display: str, demand: int) -> int:
        """Return the number of points a display may show.

        Args:
            display: its id.
            demand: how many it has to show; it counts until the next call, or `leave`.

        Returns:
            A limit of two significant digits, so that it does not change with every message.
        """
        self._demands[display] = demand
        left, waiting = self._capacity(), len(self._demands)
        for each in sorted(self._demands.values()):
            if each * waiting > left:
                break
            left, waiting = left - each, waiting - 1
        # If all have what they want, any of them may have the rest as well.
        return _rounded(left // waiting if waiting else left + demand)

    def demand(self, display: str) -> int:
        """Return the number of points that a display has to show, 0 if unknown."""
        return self._demands.get(display, 0)

    def leave(self, display: str) -> None:
        """Give what a display had to the others."""
        self._demands.pop(display, None)


def _rounded(count: int) -> int:
    """Return the next smaller number with two significant digits, at least 1."""
    unit = 10 ** max(len(str(count)) - 2, 0)
    return max(count // unit * unit, 1)
