"""ROS that does not start."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.data.words import joined


class RosNotStarted(Check):
    """ROS did not start.

    The node of webviz could not be created.

    Why:
        Without it nothing is received. The reason is often that ROS is not sourced, or is sourced
        for another version of Python.

    Repair:
        Source ROS in the terminal in which webviz is started:

            source /opt/ros/jazzy/setup.bash
    """

    id = "ENV010"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        environment = observation.environment
        if environment and environment.ros_error:
            cause, _, remedy = environment.ros_error.partition(". ")
            yield self.found(
                joined(cause),
                remedy or "Look at the reason above, and at the variables of ROS.",
                severity=Severity.ERROR,
                evidence={"python": environment.python, "error": environment.ros_error},
                command="printenv | grep -E '^(ROS|RMW|AMENT)'",
            )
