"""Transforms that lead too far away."""

from __future__ import annotations

import math
from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.checks.frames.names import is_named
from webviz.data.transforms.geometry import REACH_M
from webviz.data.transforms.reasons import Kind
from webviz.data.transforms.tree import ancestors

FAR_M = 1e5
"""Distance in metres beyond any site that a robot maps; below the northing of UTM nearly everywhere
on land."""


class OutOfReach(Check):
    """Transform that leads too far away.

    A transform places a frame so far away that nothing can be drawn there, or the data of a display
    more than 100 km from the fixed frame.

    Why:
        Usually a value in UTM coordinates or in millimetres, or an estimate that has diverged.

    Repair:
        Correct the publisher of the longest transform on the way.
    """

    id = "TF022"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such frame."""
        for symptom, reason in observation.unplaced(Kind.OUT_OF_REACH):
            yield self.found(
                f'The frame "{reason.frame}" is too far from "{observation.fixed_frame}" '
                "to be drawn.",
                "Correct the publisher of the transform.",
                subject=reason.link or reason.frame,
                severity=Severity.ERROR,
                evidence={"frame": reason.frame},
                explains=(symptom,),
            )
        if is_named(observation.fixed_frame, "earth", "utm"):
            return  # whose coordinates are that large
        frames = {each.frame for _, each in observation.inputs() if each.frame}
        chains = (ancestors(observation.buffer.tree, frame) for frame in sorted(frames))
        fixed = {*ancestors(observation.buffer.tree, observation.fixed_frame)}
        for frame in dict.fromkeys(frame for chain in chains for frame in chain):
            link = None if frame in fixed else observation.buffer.link(frame)
            distance_m = math.hypot(*link.transform.translation) if link else 0.0
            if link and FAR_M < distance_m < REACH_M:
                yield self.found(
                    f'"{frame}" is {distance_m / 1e3:.0f} km from "{link.parent}", which is usual '
                    "of UTM coordinates only.",
                    "Correct the publisher of the transform, or let it subtract the place of the "
                    "map.",
                    subject=frame,
                    evidence={"frame": frame, "distance_m": round(distance_m)},
                    command=f"ros2 run tf2_ros tf2_echo {link.parent} {frame}",
                )
