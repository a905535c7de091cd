"""Segments of shared memory of other users."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation


class ForeignSegments(Check):
    """Shared memory of another user.

    /dev/shm has segments of Fast DDS that belong to another user.

    Why:
        Fast DDS prefers shared memory on one machine. If one node runs as root and another as a
        user, they find each other and exchange nothing, since one may not open the segments of the
        other.

    Repair:
        Run all nodes as one user, or use UDP only:

            export FASTDDS_BUILTIN_TRANSPORTS=UDPv4
    """

    id = "SHM001"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        memory = observation.environment.shared_memory if observation.environment else None
        if memory is None or not memory.foreign:
            return
        explains = observation.unreceived()
        yield self.found(
            f"{len(memory.foreign)} segments of shared memory belong to another user.",
            "Run all nodes as one user, or let them use UDP only.",
            severity=Severity.WARNING if explains else Severity.NOTE,
            evidence={"segments": tuple(memory.foreign[:10])},
            command="export FASTDDS_BUILTIN_TRANSPORTS=UDPv4",
            explains=explains,
        )
