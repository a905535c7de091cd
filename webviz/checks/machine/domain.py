"""Domains that DDS cannot use."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation

MAX_DOMAIN = 232


class DomainOutOfRange(Check):
    """Domain out of range.

    ROS_DOMAIN_ID is not a number from 0 to 232.

    Why:
        The ports of DDS follow from the domain: 7400 + 250 times its number. Beyond 232 there is no
        such port, and ROS does not start.

    Repair:
        Choose a number from 0 to 101, the same on all machines:

            export ROS_DOMAIN_ID=42
    """

    id = "ENV001"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        value = (
            observation.environment.variables.get("ROS_DOMAIN_ID", "")
            if observation.environment
            else ""
        )
        if value and not (value.isdecimal() and int(value) <= MAX_DOMAIN):
            yield self.found(
                f"ROS_DOMAIN_ID is {value}, not a number from 0 to {MAX_DOMAIN}.",
                "Choose a number from 0 to 101, the same on all machines.",
                severity=Severity.ERROR,
                evidence={"ROS_DOMAIN_ID": value},
                command="export ROS_DOMAIN_ID=42",
            )
