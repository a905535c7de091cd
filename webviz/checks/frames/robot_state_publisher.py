"""Robots without a publisher for the transforms of their links."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.data.transforms.reasons import Kind

DESCRIPTION = "robot_description"
NODE = "robot_state_publisher"


class RobotStatePublisherMissing(Check):
    """robot_state_publisher is missing.

    Displays need frames that do not exist, there is no static transform, and no node publishes a
    robot description.

    Why:
        robot_state_publisher reads the URDF and publishes the transforms of all links: the fixed
        ones on /tf_static, the others from the joint states. Without it, sensors have no place on
        the robot.

    Repair:
        Start it with the description of the robot:

            ros2 launch my_robot_description description.launch.py
    """

    id = "TF012"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if frames are missing and nothing describes the robot."""
        unknown = [each for each in observation.unplaced(Kind.UNKNOWN_FRAME) if not each[1].near]
        described = any(topic.endswith(DESCRIPTION) for topic in published(observation))
        if (
            not unknown
            or described
            or observation.is_recorded
            or "/tf_static" in published(observation)
        ):
            return
        if any(NODE in node for node in observation.nodes):
            return
        yield self.found(
            "No node publishes the links of the robot.",
            "Start robot_state_publisher with the description of the robot.",
            severity=Severity.ERROR,
            evidence={"frames": tuple(dict.fromkeys(reason.frame for _, reason in unknown))[:10]},
            command="ros2 run robot_state_publisher robot_state_publisher robot.urdf",
            explains=tuple(symptom for symptom, _ in unknown),
        )


def published(observation: Observation) -> set[str]:
    """Return the topics that have a publisher."""
    return {topic for topic, offer in observation.offers.items() if offer.publishers}
