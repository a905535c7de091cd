"""A small computer, simulated: a control group with a part of one core and little memory.

A core at a fifth of its speed is not one that runs a fifth of the time. With the usual period of
100 ms, a group would rest for 80 ms whenever it has used its 20 ms, which no slow core does; with
one of 5 ms no rest is longer than 4 ms, so that latencies are those of a slow core, nearly.
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path

ROOT = Path("/sys/fs/cgroup")
NAME = f"webviz-benchmark-{os.getpid()}"
PERIOD_US = 5000
"""Period of the quota; the least quota that Linux takes is 1 ms."""


class NoControlGroups(Exception):
    """This user may make no control group here; the text says what would help."""


class SmallComputer:
    """A control group; `take` moves a process into it, with all that it will start.

    Args:
        cores: processor time in seconds per second, of all its processes together.
        memory_mb: memory that they may have.
    """

    def __init__(self, cores: float, memory_mb: int) -> None:
        quota_us, size = round(cores * PERIOD_US), memory_mb * 1_000_000
        if (ROOT / "cgroup.controllers").exists():
            values = {"cpu.max": f"{quota_us} {PERIOD_US}", "memory.max": size}
            self._groups = {ROOT / NAME: values}
        else:
            processor = {"cpu.cfs_period_us": PERIOD_US, "cpu.cfs_quota_us": quota_us}
            self._groups = {
                ROOT / "cpu" / NAME: processor,
                ROOT / "memory" / NAME: {"memory.limit_in_bytes": size},
            }

    def take(self, process: int) -> None:
        """Move a process, by its id, into it."""
        for group in self._groups:
            (group / "cgroup.procs").write_text(str(process))

    def make(self) -> None:
        """Make it.

        Raises:
            NoControlGroups: this user may not, or the kernel has none.
        """
        try:
            for group, values in self._groups.items():
                group.mkdir()
                for name, value in values.items():
                    (group / name).write_text(str(value))
        except OSError as error:
            self.remove()
            help = "run the benchmark as root, where control groups may be written"
            raise NoControlGroups(f"No control group could be made ({error}): {help}.") from error

    def remove(self) -> None:
        """Remove it, once its processes have ended."""
        for group in self._groups:
            with contextlib.suppress(OSError):
                group.rmdir()


@contextlib.contextmanager
def small_computer(cores: float | None, memory_mb: int) -> Iterator[SmallComputer | None]:
    """Yield a control group that is removed at the end; None if `cores` is None."""
    if cores is None:
        yield None
        return
    computer = SmallComputer(cores, memory_mb)
    computer.make()
    try:
        yield computer
    finally:
        computer.remove()
