"""Robots without measured joints."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.data.transforms.reasons import Kind

JOINT_STATES = "sensor_msgs/msg/JointState"


class JointStatesMissing(Check):
    """Joint states are missing.

    A robot model lacks the transforms of links, although its description is known and
    robot_state_publisher runs; nothing publishes joint states.

    Why:
        robot_state_publisher publishes the links behind movable joints only once their positions
        have arrived on /joint_states.

    Repair:
        Start the driver or the simulator of the joints. To look at a description without a robot:

            ros2 run joint_state_publisher_gui joint_state_publisher_gui
    """

    id = "TF013"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if links are missing and no joint state is published."""
        models = {each.id for each in observation.displays if each.type == "RobotModel"}
        unknown = [
            each for each in observation.unplaced(Kind.UNKNOWN_FRAME) if each[0].display in models
        ]
        types = {p.type for offer in observation.offers.values() for p in offer.publishers}
        if not unknown or JOINT_STATES in types:
            return
        yield self.found(
            "The bag has no joint states, so the poses of movable links are unknown."
            if observation.is_recorded
            else "No node publishes joint states, so the poses of movable links are unknown.",
            "Record /joint_states as well."
            if observation.is_recorded
            else "Start the driver of the joints, or joint_state_publisher.",
            severity=Severity.ERROR,
            evidence={"links": tuple(reason.frame for _, reason in unknown)[:10]},
            command="ros2 run joint_state_publisher joint_state_publisher",
            explains=tuple(symptom for symptom, _ in unknown),
        )
