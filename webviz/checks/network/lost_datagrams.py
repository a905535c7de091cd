"""Datagrams that this machine drops."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.data.words import counted

ENOUGH = 8 << 20


class LostDatagrams(Check):
    """Datagrams are dropped.

    This machine drops UDP datagrams because the receive buffer of a program is full, and the
    largest buffer that it allows is small.

    Why:
        A large message is sent as many datagrams, which arrive at once. If one is lost, a best
        effort message is lost as a whole.

    Repair:
        Allow larger buffers:

            sudo sysctl -w net.core.rmem_max=8388608
    """

    id = "NET006"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        environment = observation.environment
        if environment and environment.lost_datagrams and environment.receive_buffer < ENOUGH:
            yield self.found(
                f"{counted(environment.lost_datagrams, 'datagram')} were lost because a receive "
                "buffer was full.",
                "Allow receive buffers of 8 MB.",
                severity=Severity.NOTE,
                evidence={
                    "lost_datagrams": environment.lost_datagrams,
                    "rmem_max": environment.receive_buffer,
                },
                command=f"sudo sysctl -w net.core.rmem_max={ENOUGH}",
            )
