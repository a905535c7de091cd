"""Joint states that robot_state_publisher does not take."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from webviz.api.check import Check
from webviz.api.finding import CauseLevel, Finding, Severity, Symptom
from webviz.api.observation import NO_OFFER, Observation
from webviz.data.transforms.reasons import Kind
from webviz.data.words import counted, listed

OF_LINKS = Kind.UNKNOWN_FRAME, Kind.REFUSED, Kind.AHEAD, Kind.NO_DATA
"""Reasons why a link behind an invalid joint has no pose."""
NAMED = 3


class InvalidJointStates(Check):
    """Invalid joint states.

    A message on the topic of joint states has another number of positions than of names, or a
    position that is not finite, or lacks a joint whose link has no transform.

    Why:
        robot_state_publisher ignores a message with too few positions and joints that it does not
        know, and publishes no transforms from one with NaN, so the links stand still or are
        missing.

    Repair:
        Fill in one finite position for each name, in radians or metres, with the names of the
        joints as the URDF has them, prefix included.
    """

    id = "DATA017"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such topic while links of a robot lack transforms."""
        symptoms = tuple(symptom for symptom, _ in observation.unplaced(*OF_LINKS))
        stateless = dict(_stateless(observation))
        for topic, state in observation.joint_states.items() if symptoms else ():
            names, positions = state.name, np.asarray(state.position)
            pairs = zip(names, positions, strict=False)
            invalid = [name for name, at in pairs if not np.isfinite(at)]
            remedy = "Let its publisher send one finite position for each name."
            if len(names) != len(positions):
                cause = f"has {counted(len(names), 'name')}, but "
                cause += counted(len(positions), "position")
            elif invalid:
                cause = f"has a position of {invalid[0]} that is not a finite number"
            elif stateless and names:
                symptoms = tuple(stateless)
                cause = f"has {listed(sorted(names), NAMED)}, but not "
                cause += listed(sorted(stateless.values()), NAMED)
                remedy = "Let its publisher send all joints, by their names in the URDF."
            else:
                continue
            yield self.found(
                f"The joint state on {topic} {cause}.",
                remedy,
                subject=topic,
                severity=Severity.ERROR,
                evidence={
                    "names": len(names),
                    "positions": len(positions),
                    "invalid": len(invalid),
                },
                command=f"ros2 topic echo --once {topic}",
                explains=(*symptoms, *observation.symptom("Transforms")),
                causes=CauseLevel.FRAMES,
            )


def _stateless(observation: Observation) -> Iterator[tuple[Symptom, str]]:
    """Yield the joints that no state is of, each with the status of its link.

    None while several nodes publish joint states, as the newest message is of one of them.
    """
    publishers = [
        p
        for topic in observation.joint_states
        for p in observation.offers.get(topic, NO_OFFER).publishers
    ]
    joints = {name for state in observation.joint_states.values() for name in state.name}
    for symptom, reason in observation.unplaced(Kind.UNKNOWN_FRAME) if len(publishers) == 1 else ():
        if reason.joint and reason.joint not in joints:
            yield symptom, reason.joint
