"""Locks of programs that are gone."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.data.words import counted


class StaleLocks(Check):
    """Lock without a segment.

    Files in /dev/shm lock ports of Fast DDS that no longer exist.

    Why:
        A program that was killed leaves them. Most are cleared away by the next one; one that
        belongs to another user cannot be, and blocks its port for shared memory.

    Repair:
        Remove what no program uses:

            fastdds shm clean
    """

    id = "SHM004"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such machine."""
        memory = observation.environment.shared_memory if observation.environment else None
        if memory is None or not memory.stale_locks:
            return
        yield self.found(
            f"{counted(len(memory.stale_locks), 'lock')} in /dev/shm without a segment.",
            "Remove what programs that were killed have left.",
            severity=Severity.NOTE,
            evidence={"locks": tuple(memory.stale_locks[:10])},
            command="fastdds shm clean",
        )
