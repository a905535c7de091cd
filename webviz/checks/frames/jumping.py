"""Transforms that jump."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation
from webviz.checks.frames.names import is_named
from webviz.data.transforms.cache import TimeCache

WORLDS = ("map", "odom", "world", "earth")
"""Frames in which a robot moves."""
LEAST_M = 0.3
FASTEST_M_S = 12.0
"""Robots that are faster are rare, and move as fast in the next moment too."""
RATIO = 10.0
"""Ratio between a jump and the middle one of all steps."""
FEWEST_OF_MAP, FEWEST = 4, 2
"""Jumps within the ten seconds that are kept. Localisation corrects itself now and then; odometry
must be continuous (REP 105)."""


class JumpingTransform(Check):
    """Transform that jumps.

    The pose of a robot in its map or odometry jumps again and again by more than it can have moved.

    Why:
        Localisation switches between two places that look alike, or an odometry is set back. What
        is drawn jumps along, and what the planner remembers of obstacles is smeared.

    Repair:
        Give the pose with the tool 2D Pose Estimate, and check the laser and the map. Of an
        odometry, which must be continuous, look for resets of its counters and for a filter that
        fuses two poses that disagree.
    """

    id = "TF026"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each link between a world and a robot that jumps."""
        conflicting = {frame for frame, _ in observation.buffer.conflicts.all()}
        for frame, cache in observation.buffer.tree.caches.items():
            parent = cache.parent
            if not isinstance(cache, TimeCache) or not parent or not is_named(parent, *WORLDS):
                continue
            if frame in conflicting:
                continue
            jumps = _jumps(cache)
            is_local = is_named(parent, "odom")
            if len(jumps) < (FEWEST if is_local else FEWEST_OF_MAP):
                continue
            yield self.found(
                f'The transform from "{parent}" to "{frame}" jumped {len(jumps)} times, by up to '
                f"{max(jumps):.1f} m.",
                "Check the odometry for resets."
                if is_local
                else "Give the pose with the tool 2D Pose Estimate; check the laser and the map.",
                subject=frame,
                evidence={"parent": parent, "jumps": len(jumps), "longest_m": round(max(jumps), 2)},
                command=f"ros2 run tf2_ros tf2_echo {parent} {frame}",
                explains=observation.off_map(),
            )


def _jumps(cache: TimeCache) -> Sequence[float]:
    """Return the steps in metres that are much longer than the others, and too fast."""
    translations = cache.translations()
    if not np.isfinite(translations).all():
        return ()
    steps = np.linalg.norm(np.diff(translations, axis=0), axis=1).tolist()
    if not steps or max(steps) < LEAST_M:
        return ()
    usual = sorted(steps)[len(steps) // 2]
    seconds = [(after - before) / 1e9 for before, after in pairwise(cache.stamps)]
    return [
        step
        for step, took_s in zip(steps, seconds, strict=True)
        if step > max(LEAST_M, RATIO * usual, FASTEST_M_S * took_s)
    ]
