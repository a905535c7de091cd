"""Shared memory that cannot be written."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation


class SharedMemoryReadOnly(Check):
    """Shared memory cannot be written.

    This program may not create files in /dev/shm.

    Why:
        Fast DDS sends through shared memory on one machine. Without it, it may fall back to UDP,
        or lose what other nodes send. In a container the file system is mounted read-only, or
        belongs to another user.

    Repair:
        Give it the usual rights, or start the container with `--ipc=host`:

            sudo chmod 1777 /dev/shm
    """

    id = "SHM006"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        memory = observation.environment.shared_memory if observation.environment else None
        if memory is None or memory.is_writable:
            return
        yield self.found(
            "/dev/shm cannot be written, so nodes of this machine may not receive from each other.",
            "Mount /dev/shm writable with mode 1777, or start the container with --ipc=host.",
            evidence={"free": memory.free},
            command="ls -ld /dev/shm",
            explains=observation.unreceived(),
        )
