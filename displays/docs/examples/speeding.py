"""A check of the doctor: a robot that drives too fast."""

import math
from collections.abc import Iterator

from webviz import Check, Finding, Observation

LIMIT = 1.5
"""Metres per second."""


class Speeding(Check):
    """Robot that drives too fast.

    The odometry has a speed above 1.5 m/s, the limit of our halls.

    Why:
        The safety lasers are set up for that speed: the robot cannot stop in their range.

    Repair:
        Lower the maximum speed of the controller.
    """

    id = "DATA901"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such topic."""
        for _, each in observation.samples("nav_msgs/msg/Odometry"):
            velocity = each.message.twist.twist.linear
            speed = math.hypot(velocity.x, velocity.y)
            if speed > LIMIT:
                yield self.found(
                    f"The robot drives at {speed:.1f} m/s; the limit is {LIMIT} m/s.",
                    "Lower the maximum speed of its controller.",
                    subject=each.topic,
                    evidence={"speed": round(speed, 2)},
                )
