"""Joint states that robot_state_publisher does not take."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from webviz.api.check import Check
from webviz.api.finding import CauseLevel, Finding, Severity
from webviz.api.observation import Observation
from webviz.data.transforms.reasons import Kind
from webviz.data.words import counted

OF_LINKS = Kind.UNKNOWN_FRAME, Kind.REFUSED, Kind.AHEAD, Kind.NO_DATA
"""Reasons why a link behind an invalid joint has no pose."""


class InvalidJointStates(Check):
    """Invalid joint states.

    A message on the topic of joint states has another number of positions than of names, or a
    position that is not finite.

    Why:
        robot_state_publisher ignores a message with too few positions, and publishes no transforms
        from one with NaN, so the links stand still or are missing.

    Repair:
        Fill in one finite position for each name, in radians or metres.
    """

    id = "DATA017"

    def find(self, seen: Observation) -> Iterator[Finding]:
        """Yield a finding for each such topic while links of a robot lack transforms."""
        lost = tuple(symptom for symptom, _ in seen.lost(*OF_LINKS))
        for topic, state in seen.joint_states.items() if lost else ():
            names, positions = state.name, np.asarray(state.position)
            pairs = zip(names, positions, strict=False)
            invalid = [name for name, at in pairs if not np.isfinite(at)]
            if len(names) != len(positions):
                given = counted(len(positions), "position")
                cause = f"has {counted(len(names), 'name')}, but {given}"
            elif invalid:
                cause = f"has a position of {invalid[0]} that is not a finite number"
            else:
                continue
            yield self.found(
                f"The joint state on {topic} {cause}.",
                "Let its publisher send one finite position for each name.",
                subject=topic,
                severity=Severity.ERROR,
                evidence={
                    "names": len(names),
                    "positions": len(positions),
                    "invalid": len(invalid),
                },
                command=f"ros2 topic echo --once {topic}",
                explains=(*lost, *seen.symptom("Transforms")),
                causes=CauseLevel.FRAMES,
            )
