"""Robots without odometry."""

from __future__ import annotations

import re
from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity, Symptom
from webviz.api.observation import Observation
from webviz.checks.frames.names import is_named
from webviz.data.transforms.reasons import Kind

BASE = re.compile(r"(.*[/_])?base\w*")
"""Pattern of frames of a base, such as base_link; its group is the prefix of the robot."""


class OdometryMissing(Check):
    """Odometry is missing.

    The robot and the frame `odom` are known, and no transform connects them.

    Why:
        The odometry of the robot, or a filter such as robot_localization, publishes the transform
        from `odom` to the base. Without it, the robot has no place in the map.

    Repair:
        Start the driver of the base, or switch on its transform: `enable_odom_tf` of
        diff_drive_controller, `publish_tf` of robot_localization.
    """

    id = "TF005"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if the base is the root of a tree besides that of odom."""
        gaps = list(unconnected(observation))
        if gaps:
            _, base, odom = gaps[-1]
            yield self.found(
                f'Nothing publishes the transform from "{odom}" to "{base}".',
                "Start the odometry of the robot, or let it publish its transform.",
                subject=base,
                severity=Severity.ERROR,
                evidence={"base": base, "publishers": observation.nodes_of("/odom")},
                command="ros2 topic info /odom --verbose",
                explains=odometry_lost(observation),
            )


def odometry_lost(observation: Observation) -> tuple[Symptom, ...]:
    """Return the statuses of frames that lack the transform of the odometry."""
    return tuple(symptom for symptom, _, _ in unconnected(observation))


def unconnected(observation: Observation) -> Iterator[tuple[Symptom, str, str]]:
    """Yield these statuses, each with the frames of the base and of the odometry."""
    tree = observation.buffer.tree
    for symptom, reason in observation.unplaced(Kind.NOT_CONNECTED):
        root, fixed_root = reason.roots or ("", "")
        if (base := BASE.fullmatch(root)) is None:
            continue
        own = f"{base[1] or ''}odom"
        if own in tree.names and tree.root(own) == fixed_root:
            yield symptom, root, own
    for symptom, reason in observation.unplaced(Kind.UNKNOWN_FRAME):
        if is_named(reason.frame, "odom"):
            yield symptom, observation.fixed_frame, reason.frame
