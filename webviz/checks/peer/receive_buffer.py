"""Receive buffers of the other machine."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation

ENOUGH = 8 << 20


class PeerReceiveBuffer(Check):
    """Small receive buffers on the peer.

    The other machine limits receive buffers of sockets to less than 8 MB.

    Why:
        A large message is sent as many datagrams, which arrive at once. If one is lost, a best
        effort message is lost as a whole.

    Repair:
        If large messages do not arrive there, allow larger buffers:

            sudo sysctl -w net.core.rmem_max=8388608
    """

    id = "NET023"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        there = observation.ends.there if observation.ends else None
        if there is not None and 0 < there.receive_buffer < ENOUGH:
            yield self.found(
                f"{there.host} limits receive buffers to {there.receive_buffer // 1024} kB.",
                "If large messages do not arrive there, allow receive buffers of 8 MB.",
                subject=there.host,
                severity=Severity.NOTE,
                evidence={"rmem_max": there.receive_buffer},
                command=f"sudo sysctl -w net.core.rmem_max={ENOUGH}",
            )
