"""Maps without a robot in them."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.api.status import OtherFixedFrame
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

    def find(self, seen: Observation) -> Iterator[Finding]:
        """Yield a finding if the map is the fixed frame and the robot is not connected to it."""
        frames, explains = seen.buffer.frames(), []
        for symptom, reason in seen.lost(Kind.UNKNOWN_FIXED_FRAME, Kind.NOT_CONNECTED):
            is_unknown = reason.kind is Kind.UNKNOWN_FIXED_FRAME and not reason.near
            if is_unknown or reason.roots == ("odom", seen.fixed_frame):
                explains.append(symptom)
        is_wanted = seen.fixed_frame == "map"
        for symptom, reason in seen.lost(Kind.UNKNOWN_FRAME):
            if reason.frame == "map":
                explains.append(symptom)
                is_wanted = True
        robot = next(
            (name for name in ("odom", "base_footprint", "base_link") if name in frames), ""
        )
        if not is_wanted or not robot or not explains:
            return
        amcl = next((node for node in seen.nodes if node.rpartition("/")[2] == "amcl"), "")
        start = "Give AMCL the initial pose (2D Pose Estimate)." if amcl else "Start AMCL or SLAM."
        yield self.found(
            f'Nothing publishes the transform from "map" to "{robot}".',
            f'{start} Until then, use "{robot}" as the fixed frame.',
            subject=robot,
            severity=Severity.ERROR,
            evidence={"root": robot, "amcl": amcl},
            command=""
            if seen.is_recorded or amcl
            else "ros2 launch nav2_bringup localization_launch.py",
            button=OtherFixedFrame(robot),
            explains=tuple(explains),
        )
