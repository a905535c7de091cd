"""Machines without a network."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation


class NoNetwork(Check):
    """Only loopback is up.

    No interface of the network is up besides loopback.

    Why:
        Nodes of this machine are found, those of other machines are not. In a container this is so
        without `--network host`.

    Repair:
        Connect the network, or start the container with `--network host`.
    """

    id = "NET003"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        interfaces = observation.environment.interfaces if observation.environment else ()
        if not interfaces or any(not each.is_loopback for each in interfaces):
            return
        explains = observation.undiscovered()
        yield self.found(
            "This machine has no network besides loopback, so it sees its own nodes only.",
            "Connect the network, or start the container with --network host.",
            severity=Severity.WARNING if explains else Severity.NOTE,
            evidence={"interfaces": tuple(each.name for each in interfaces)},
            command="ip -brief address",
            explains=explains,
        )
