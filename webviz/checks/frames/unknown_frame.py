"""Frames that nothing publishes."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.checks.frames.names import is_named
from webviz.data.transforms.reasons import Kind

WORLDS = ("map", "odom", "world", "earth", "utm")
"""Frames that the robot moves in, so that they are not mounted on it."""
BASES = ("base_link", "base_footprint")


class UnknownFrame(Check):
    """Unknown frame.

    Data is in a frame to which no transform leads.

    Why:
        The sensor is not part of the robot description, or the node that publishes its transform is
        not running.

    Repair:
        Add the sensor to the URDF, or publish where it is mounted:

            ros2 run tf2_ros static_transform_publisher --frame-id base_link --child-frame-id laser
    """

    id = "TF017"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such frame."""
        for symptom, reason in observation.unplaced(Kind.UNKNOWN_FRAME):
            if reason.near:
                continue
            is_world = is_named(reason.frame, *WORLDS)
            frames = sorted(observation.buffer.frames())
            base = next((each for name in BASES for each in frames if is_named(each, name)), "")
            yield self.found(
                f'No transform leads to the frame "{reason.frame}".',
                "Start what places the robot in it, or correct the frame id of the data."
                if is_world
                else "Publish where it is mounted, or correct the frame id of the data.",
                subject=reason.link or reason.frame,
                severity=Severity.ERROR,
                evidence={"frame": reason.frame},
                command=""
                if is_world or not base
                else "ros2 run tf2_ros static_transform_publisher "
                f"--frame-id {base} --child-frame-id {reason.frame}",
                explains=(symptom,),
            )
