"""Offsets of stamps from the clock, as far as they are steady."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from statistics import median_low

from webviz.api.observation import InputSeen, Observation
from webviz.data.transforms.cache import TimeCache

MEASURED = {
    f"{package}/msg/{name}"
    for package, name in (
        ("nav_msgs", "Odometry"),
        ("sensor_msgs", "Imu"),
        ("sensor_msgs", "JointState"),
        ("sensor_msgs", "LaserScan"),
        ("sensor_msgs", "Range"),
    )
}
"""Types that are sent as they are measured; clouds and images may take time to compute."""
FEWEST = 5
"""Stamps that show whether an offset is steady."""
STEADY_NS = 100_000_000
"""Largest difference in ns from the least of steady delays to their median, and the largest delay
of what is on time."""
OFF_NS = 300_000_000
"""Offset beyond that of any sensor: a sweep at 5 Hz takes 0.2 s."""
LARGE_NS = 1_500_000_000
"""Offset that matters whether or not it is steady."""
ROUNDS = 4
"""Rounds in which the offset of a transform must be the same."""


def delays_of(each: InputSeen) -> list[int]:
    """Return the times from stamps to receptions of the last stamped messages in ns."""
    return [received_ns - stamp_ns for stamp_ns, received_ns in each.stamps if stamp_ns]


def measured(observation: Observation) -> Mapping[str, int]:
    """Return the steady delays of what is sent as it is measured in ns, by topic."""
    delays_ns: dict[str, int] = {}
    for _, each in observation.inputs():
        delays = delays_of(each)
        is_known = each.type in MEASURED and len(delays) >= FEWEST and each.rate_hz > 1.0
        if is_known and (delay_ns := steady(delays)) is not None:
            delays_ns[each.topic] = delay_ns
    return delays_ns


def steady(delays: Sequence[int]) -> int | None:
    """Return the least of some delays, None if half of them are longer by more than a little.

    What holds messages up only adds to the offset of a clock, so that the least shows it best, as
    in the clock filter of NTP (RFC 5905, section 10).
    """
    least = min(delays)
    return least if median_low(delays) - least < STEADY_NS else None


def linked(observation: Observation) -> Mapping[str, int]:
    """Return the delays of moving frames in ns, those of their newest transforms."""
    caches = observation.buffer.tree.caches.items()
    moving = ((child, cache) for child, cache in caches if isinstance(cache, TimeCache) and cache)
    return {child: ns for child, cache in moving if (ns := cache.delay_ns) is not None}


def off_alone(observation: Observation) -> Mapping[str, int]:
    """Return the steady delays in ns of topics that are off, while others are on time.

    These show that this computer keeps up, and that its clock is that of the others.
    """
    delays, links = measured(observation), linked(observation)
    usual_ns = median_low(links.values()) if links else None  # localisation may post-date its own
    return {
        topic: ns
        for topic, ns in delays.items()
        if abs(ns) > OFF_NS
        and any(
            other_ns is not None and abs(other_ns) < STEADY_NS
            for other_ns in (*(each for key, each in delays.items() if key != topic), usual_ns)
        )
    }


def off_together(observation: Observation) -> int | None:
    """Return the delay in ns that all data and most transforms share, None without such a fault.

    A slow link holds up everything, too, as do recorders, so neither bridges nor bags are judged.
    """
    delays, links = measured(observation), linked(observation)
    if not delays or not links or observation.bridges or observation.is_recorded:
        return None
    all_ns = (*delays.values(), median_low(links.values()))
    is_off = all(OFF_NS < abs(ns) < LARGE_NS for ns in all_ns)
    return median_low(all_ns) if is_off and max(all_ns) - min(all_ns) < STEADY_NS else None


class LateLinks:
    """Notices transforms that are late by the same time in each round."""

    def __init__(self) -> None:
        self._delays: dict[str, list[int]] = {}
        """Delays in the last rounds in ns, by child frame."""

    def update(self, observation: Observation) -> Mapping[str, int]:
        """Return the delay of such frames in ns, if data of sensors is on time."""
        earlier, self._delays = self._delays, {}
        for child, ns in linked(observation).items():
            self._delays[child] = [*earlier.get(child, ()), ns][-ROUNDS:]
        if not any(abs(ns) < STEADY_NS for ns in measured(observation).values()):
            return {}
        earlier = {child: ns for child, ns in self._delays.items() if len(ns) == ROUNDS}
        return {
            child: ns
            for child, delays in earlier.items()
            if (ns := steady(delays)) is not None and OFF_NS < ns < LARGE_NS
        }
