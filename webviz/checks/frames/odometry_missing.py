"""Robots without odometry."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.data.transforms.reasons import Kind


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

    def find(self, seen: Observation) -> Iterator[Finding]:
        """Yield a finding if the base is the root of a tree besides that of odom."""
        tree, explains, base = seen.buffer.tree, [], ""
        for symptom, reason in seen.lost(Kind.NOT_CONNECTED):
            root, fixed_root = reason.roots or ("", "")
            known = "odom" in tree.names and tree.root("odom") == fixed_root
            if root.startswith("base") and known:
                explains.append(symptom)
                base = root
        for symptom, reason in seen.lost(Kind.UNKNOWN_FRAME):
            if reason.frame == "odom":
                explains.append(symptom)
                base = seen.fixed_frame
        if explains:
            yield self.found(
                f'Nothing publishes the transform from "odom" to "{base}".',
                "Start the odometry of the robot, or let it publish its transform.",
                subject=base,
                severity=Severity.ERROR,
                evidence={"base": base, "publishers": seen.nodes_of("/odom")},
                command="ros2 topic info /odom --verbose",
                explains=tuple(explains),
            )
