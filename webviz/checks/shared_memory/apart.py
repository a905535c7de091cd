"""Programs with shared memory of their own."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation


class SharedMemoryApart(Check):
    """Separate shared memory.

    ROS programs of this machine use its network, and shared memory of their own.

    Why:
        A container with `--network host` has its own /dev/shm unless it is started with
        `--ipc=host`. Fast DDS takes its nodes for nodes of the same machine and sends through
        shared memory, which they do not share: topics are listed and stay silent.

    Repair:
        Start the container with `--ipc=host`, or let all nodes use UDP only:

            export FASTDDS_BUILTIN_TRANSPORTS=UDPv4
    """

    id = "SHM005"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        memory = observation.environment.shared_memory if observation.environment else None
        if memory is None or not memory.apart:
            return
        explains = observation.unreceived()
        yield self.found(
            f"Programs of ROS have shared memory of their own: {memory.apart[0]}.",
            "Start their container with --ipc=host, or let all nodes use UDP only.",
            severity=Severity.WARNING if explains else Severity.NOTE,
            evidence={"programs": tuple(memory.apart)},
            command="export FASTDDS_BUILTIN_TRANSPORTS=UDPv4",
            explains=explains,
        )
