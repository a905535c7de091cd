"""Intensities that say nothing."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation

SCAN = "sensor_msgs/msg/LaserScan"
FEWEST = 10


class ConstantIntensities(Check):
    """Constant intensities.

    All intensities of a laser scan are equal.

    Why:
        Colouring by intensity shows one colour then. Many drivers send zeros or a constant.

    Repair:
        Colour the scan by an axis or by range.
    """

    id = "DATA009"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such topic."""
        for _, each in observation.samples(SCAN):
            values = np.asarray(each.message.intensities)
            if len(values) >= FEWEST and float(values.min()) == float(values.max()):
                yield self.found(
                    f"All intensities on {each.topic} are {float(values[0]):g}.",
                    "Colour the scan by range or by an axis.",
                    subject=each.topic,
                    severity=Severity.NOTE,
                    evidence={"intensity": float(values[0])},
                )
