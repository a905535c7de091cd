"""Security without its files."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation


class EnclaveMissing(Check):
    """Security without an enclave.

    ROS_SECURITY_ENABLE is true, and the keystore, or the enclave in it, does not exist.

    Why:
        With ROS_SECURITY_STRATEGY=Enforce no node starts then. Otherwise nodes start without
        security, and secured nodes do not talk to them.

    Repair:
        Create the enclave, or switch security off:

            unset ROS_SECURITY_ENABLE
    """

    id = "ENV014"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such machine."""
        if (environment := observation.environment) is None or not environment.security_problem:
            return
        is_enforced = environment.variables.get("ROS_SECURITY_STRATEGY") == "Enforce"
        yield self.found(
            f"ROS_SECURITY_ENABLE is true, but {environment.security_problem}.",
            "Create the enclave in the keystore, or unset ROS_SECURITY_ENABLE.",
            severity=Severity.ERROR if is_enforced else Severity.WARNING,
            evidence={
                "keystore": environment.variables.get("ROS_SECURITY_KEYSTORE", ""),
                "strategy": environment.variables.get("ROS_SECURITY_STRATEGY", ""),
            },
            command="unset ROS_SECURITY_ENABLE",
        )
