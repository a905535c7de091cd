"""Rate of ROS time, so that a page counts between messages."""

from __future__ import annotations

from collections import deque

from webviz.engine.state import ClockRate

SPAN_S = 3.0
"""Time in seconds over which the rate is measured."""
STILL_S = 0.3
"""Time that has not moved for so long stands still; a /clock of less than 4 Hz comes in steps."""
TOLERANCE_NS = 150_000_000
"""Error in ns of a page from which on it is corrected; a /clock of 10 Hz has steps of 0.1 s."""
NEARLY = 0.02
"""A rate that differs by less is 1."""


class ClockRateMeter:
    """Follows ROS time, and makes a new `ClockRate` only if the last one is no longer right."""

    def __init__(self) -> None:
        self._samples: deque[tuple[int, float]] = deque()
        self._moved_s = 0.0
        self._time_rate = ClockRate()

    def step(self, ros_ns: int, wall_s: float, is_paused: bool = False) -> ClockRate:
        """Take both times of one moment; how ROS time goes on from there."""
        samples = self._samples
        if is_paused or (samples and not 0.0 <= wall_s - samples[-1][1] <= SPAN_S):
            samples.clear()  # what was measured before says nothing
        if not samples or samples[-1][0] != ros_ns:
            self._moved_s = wall_s
        samples.append((ros_ns, wall_s))
        while len(samples) > 2 and wall_s - samples[0][1] > SPAN_S:
            samples.popleft()
        rate = 0.0 if is_paused else self._rate(ros_ns, wall_s)
        clock_rate = self._time_rate
        is_right = abs(clock_rate.at(wall_s) - ros_ns) <= TOLERANCE_NS and (rate == 0) == (
            clock_rate.rate == 0
        )
        if not is_right or (rate == 0 and clock_rate.ros_ns != ros_ns):
            self._time_rate = ClockRate(ros_ns, wall_s, rate)
        return self._time_rate

    def _rate(self, ros_ns: int, wall_s: float) -> float:
        """Seconds of ROS time per second; 1 until it is known better."""
        first_ns, first_s = self._samples[0]
        if wall_s - self._moved_s >= STILL_S or not ros_ns:
            return 0.0
        if wall_s - first_s < STILL_S or ros_ns < first_ns:
            return 1.0
        rate = round((ros_ns - first_ns) / 1e9 / (wall_s - first_s), 3)
        return 1.0 if abs(rate - 1.0) < NEARLY else rate


class Rate:
    """Rate per second of a counted event."""

    def __init__(self) -> None:
        self._counts: deque[tuple[int, float]] = deque()

    def step(self, count: int, now_s: float) -> float:
        """Take the count of a moment; the rate over the last seconds."""
        counts = self._counts
        counts.append((count, now_s))
        while len(counts) > 2 and now_s - counts[1][1] >= SPAN_S:
            counts.popleft()
        first, first_s = counts[0]
        return max(0, count - first) / (now_s - first_s) if now_s > first_s else 0.0
