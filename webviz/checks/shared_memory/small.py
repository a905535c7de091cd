"""Shared memory that is small."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation

SMALL = 64 << 20


class SmallSharedMemory(Check):
    """Small shared memory.

    /dev/shm has 64 MB or less, as in a container by default.

    Why:
        Fast DDS reserves segments for each node there. When it is used up, large messages are lost
        or nodes do not start.

    Repair:
        Give the container more, or that of the host:

            docker run --shm-size=1g --ipc=host …
    """

    id = "SHM002"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        memory = observation.environment.shared_memory if observation.environment else None
        if memory is not None and memory.size <= SMALL:
            yield self.found(
                f"Shared memory has only {memory.size >> 20} MB.",
                "Start the container with --shm-size=1g or --ipc=host.",
                severity=Severity.NOTE,
                evidence={"size": memory.size, "free": memory.free},
                command="df -h /dev/shm",
            )
