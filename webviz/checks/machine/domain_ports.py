"""Domains whose ports other programs may hold."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation

FIRST, LAST = 102, 214


class DomainPorts(Check):
    """Domain among ephemeral ports.

    ROS_DOMAIN_ID is from 102 to 214, so that its ports are among those that Linux gives to other
    programs.

    Why:
        If another program holds the port, a node does not start, or is not found; after a restart
        it may work.

    Repair:
        Choose a number from 0 to 101.
    """

    id = "ENV002"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        value = (
            observation.environment.variables.get("ROS_DOMAIN_ID", "")
            if observation.environment
            else ""
        )
        if value.isdecimal() and FIRST <= int(value) <= LAST:
            yield self.found(
                f"The ports of domain {value} are among those that Linux gives to other programs.",
                "Choose a domain from 0 to 101.",
                severity=Severity.NOTE,
                evidence={"ROS_DOMAIN_ID": value},
                command="export ROS_DOMAIN_ID=42",
            )
