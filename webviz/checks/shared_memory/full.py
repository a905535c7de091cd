"""Shared memory that is full."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation

LEAST = 4 << 20


class FullSharedMemory(Check):
    """Shared memory is full.

    Less than 4 MB of /dev/shm are free.

    Why:
        Segments of nodes that crashed stay behind. Without room, Fast DDS cannot make the segments
        of a new node, whose large messages are lost.

    Repair:
        Stop all nodes, and remove what they left:

            rm /dev/shm/fastrtps_* /dev/shm/fastdds_*
    """

    id = "SHM003"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        memory = observation.environment.shared_memory if observation.environment else None
        if memory is not None and memory.free < LEAST:
            yield self.found(
                f"Only {memory.free >> 10} kB of shared memory are free.",
                "Stop all nodes, and remove the segments that they left in /dev/shm.",
                evidence={"size": memory.size, "free": memory.free},
                command="ls -l /dev/shm",
            )
