"""The limit of the size of a file: how much of it each part may take, and what was left out."""

from __future__ import annotations

import msgspec

MAX_EVERY = 16
"""First at least one of so many points of large clouds is kept, then versions of what is large are
left out."""
MAX_SKIP = 64
RESERVE = 400_000
"""Bytes for what comes at the end of the file."""


class SizeLimit(msgspec.Struct):
    """Shares the room of a file among its seconds.

    Args:
        bytes: of the whole file.
        duration_s: of the run.
    """

    bytes: int
    duration_s: float
    every: int = 1
    """Number of points of clouds of which one is kept."""
    skip: int = 1
    """Number of versions of a large cloud, map, mesh or picture of which one is kept."""
    _thinned: list[tuple[float, float, int, int]] = msgspec.field(
        default_factory=list[tuple[float, float, int, int]]
    )

    @property
    def is_exceeded(self) -> bool:
        """Return whether something has to be left out now."""
        return self.every > 1 or self.skip > 1

    def room(self, used: int, first_s: float, last_s: float) -> float:
        """Return how many packed bytes the seconds between two times may have.

        Args:
            used: size of the file before them.
            first_s, last_s: from the start of the run.
        """
        rest_s = max(self.duration_s - first_s, 1e-3)
        left = max(0, self.bytes - RESERVE - used) * 3 / 4  # base64
        return left * min(1.0, max(last_s - first_s, 0.1) / rest_s)

    def adapt(self, size: int, room: float, first_s: float, last_s: float) -> None:
        """Note how a part was made, and choose how the next one begins."""
        if self.is_exceeded:
            self._thinned.append((first_s, last_s, self.every, self.skip))
        if size > room:
            self.skip = min(self.skip * 2, MAX_SKIP)
        elif size < room / 4 and self.skip > 1:
            self.skip //= 2
        elif self.skip == 1:
            self.every = max(1, self.every // 2)

    def notes(self) -> list[str]:
        """Sentences on what was left out."""
        notes: list[str] = []
        if self._thinned:
            first_s, last_s = self._thinned[0][0], self._thinned[-1][1]
            when = f"between {first_s:.1f} and {last_s:.1f} s"
            every, skip = (max(each[part] for each in self._thinned) for part in (2, 3))
            if every > 1:
                notes.append(f"Clouds keep at least one of {every} points {when}.")
            if skip > 1:
                what = f"at least one of {skip} versions is shown"
                notes.append(f"Of clouds, maps and pictures, {what} {when}.")
            notes.append(f"Values of selected points are missing {when}.")
        return notes
