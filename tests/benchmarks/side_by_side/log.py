"""Matching of sightings with publications, and their delays."""

from __future__ import annotations

import struct
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

RECORD = struct.Struct("<qqqq")
"""Lane, publication, stamp, time of publication."""


@dataclass(frozen=True)
class Sighting:
    """A publication seen by a client.

    Args:
        time_ns: when all its bytes were there.
        lane: of the stream; None if it was recognised by its stamp.
        key: the publication modulo `cycle`, or the stamp in ns modulo `cycle`.
        cycle: 0 if the key is whole.
    """

    time_ns: int
    lane: int | None
    key: int
    cycle: int = 0


class Log:
    """The publisher's log, as far as it is written."""

    def __init__(self, path: Path) -> None:
        size = path.stat().st_size // RECORD.size
        self._rows = np.fromfile(path, np.int64, 4 * size).reshape(-1, 4)
        self._of_lane: dict[int, NDArray[np.int64]] = {
            lane: self._rows[self._rows[:, 0] == lane] for lane in np.unique(self._rows[:, 0])
        }

    def published(self, lane: int, since_ns: int, until_ns: int) -> int:
        """Return the number of publications in a span of time."""
        return len(self._between(lane, since_ns, until_ns))

    def latencies(
        self, sightings: Iterable[Sighting], since_ns: int, until_ns: int
    ) -> dict[int, list[float]]:
        """Milliseconds from publication to first sight by lane, of what was published in a span."""
        result = self.publications(sightings, since_ns, until_ns)
        return {lane: [ms for _, ms in each] for lane, each in result.items()}

    def publications(
        self, sightings: Iterable[Sighting], since_ns: int, until_ns: int
    ) -> dict[int, list[tuple[int, float]]]:
        """Return the same, each with its time of publication in nanoseconds."""
        first: dict[tuple[int, int], int] = {}
        for sighting in sightings:
            result = self._find(sighting)
            if result is not None and since_ns <= result[3] < until_ns:
                first.setdefault((int(result[0]), int(result[3])), sighting.time_ns)
        late: dict[int, list[tuple[int, float]]] = defaultdict(list)
        for (lane, published), sighted_ns in first.items():
            late[lane].append((published, (sighted_ns - published) / 1e6))
        return late

    def gaps(self, sightings: Iterable[Sighting], until_ns: int) -> dict[int, float]:
        """Seconds of the longest time without a new publication, up to `until_ns`, by lane."""
        times_by_lane: dict[int, dict[int, int]] = defaultdict(dict)
        for sighting in sightings:
            if (result := self._find(sighting)) is not None:
                times_by_lane[int(result[0])].setdefault(int(result[1]), sighting.time_ns)
        return {
            lane: max(np.diff([*sorted(times.values()), until_ns])) / 1e9
            for lane, times in times_by_lane.items()
        }

    def _between(self, lane: int, since_ns: int, until_ns: int) -> NDArray[np.int64]:
        rows = self._of_lane.get(lane, self._rows[:0])
        return rows[(rows[:, 3] >= since_ns) & (rows[:, 3] < until_ns)]

    def _find(self, sighting: Sighting) -> NDArray[np.int64] | None:
        """The newest publication before the sighting that fits."""
        column = 2 if sighting.lane is None else 1
        rows = self._rows if sighting.lane is None else self._of_lane.get(sighting.lane)
        if rows is None:
            return None
        keys = rows[:, column] % sighting.cycle if sighting.cycle else rows[:, column]
        fitting = np.flatnonzero((keys == sighting.key) & (rows[:, 3] <= sighting.time_ns))
        return rows[fitting[-1]] if len(fitting) else None
