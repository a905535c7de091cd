"""Maps without a robot in them."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity, Symptom
from webviz.api.observation import Observation
from webviz.api.status import OtherFixedFrame
from webviz.checks.frames.names import is_named
from webviz.data.transforms.reasons import Kind

ROBOT = ("odom", "base_footprint", "base_link")
"""Uppermost frames of a robot, by preference."""
LAUNCH = "ros2 launch nav2_bringup localization_launch.py"


class LocalisationMissing(Check):
    """Localisation is missing.

    Displays need the map, and no transform leads from it to the robot.

    Why:
        The odometry only knows where the robot has moved since it was started. Localisation (AMCL)
        or SLAM publishes the transform from `map` to `odom`, and AMCL only once it knows where to
        begin.

    Repair:
        Start AMCL or SLAM. If AMCL runs, give it the initial pose with the tool 2D Pose Estimate.
    """

    id = "TF003"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each robot that is not connected to the map."""
        frames = sorted(observation.buffer.frames())
        robot = next((frame for name in ROBOT for frame in frames if is_named(frame, name)), "")
        is_wanted = is_named(observation.fixed_frame, "map")
        missing: dict[str, list[Symptom]] = {}
        for symptom, reason in observation.unplaced(Kind.UNKNOWN_FIXED_FRAME, Kind.NOT_CONNECTED):
            root, fixed_root = reason.roots or ("", "")
            if is_named(root, "odom") and fixed_root == observation.fixed_frame:
                missing.setdefault(root, []).append(symptom)
            elif reason.kind is Kind.UNKNOWN_FIXED_FRAME and not reason.near:
                missing.setdefault(robot, []).append(symptom)
        for symptom, reason in observation.unplaced(Kind.UNKNOWN_FRAME):
            if is_named(reason.frame, "map"):
                missing.setdefault(robot, []).append(symptom)
                is_wanted = True
        amcl = next((node for node in observation.nodes if node.rpartition("/")[2] == "amcl"), "")
        start = "Give AMCL the initial pose (2D Pose Estimate)." if amcl else "Start AMCL or SLAM."
        for root, explains in missing.items() if is_wanted else ():
            if not root:
                continue
            yield self.found(
                f'Nothing publishes the transform from "map" to "{root}".',
                f'{start} Until then, use "{root}" as the fixed frame.',
                subject=root,
                severity=Severity.ERROR,
                evidence={"root": root, "amcl": amcl},
                command="" if observation.is_recorded or amcl else LAUNCH,
                button=OtherFixedFrame(root),
                explains=tuple(explains),
            )
