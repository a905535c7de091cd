"""Memory that this machine, or the container of this process, has."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import psutil

CGROUPS = Path("/sys/fs/cgroup")
OWN = Path("/proc/self/cgroup")
LIMITS = ("memory.max", "memory.high")
"""Files of a control group with a limit in bytes, or "max" for none, as the documentation of the
kernel says of cgroup v2."""


@cache
def memory_bytes() -> int:
    """Return the bytes of memory that this process may use."""
    return min([psutil.virtual_memory().total, *_limits()])


def _limits() -> list[int]:
    """Return the limits of the control groups that this process is in, which psutil ignores."""
    try:
        lines = OWN.read_text(encoding="utf-8").splitlines()
    except OSError:  # not on Linux
        return []
    own = next((line.removeprefix("0::/") for line in lines if line.startswith("0::/")), None)
    if own is None:
        return []
    limits: list[int] = []
    group = CGROUPS / own
    for folder in (group, *group.parents):
        for name in LIMITS:
            try:
                text = (folder / name).read_text(encoding="utf-8").strip()
            except OSError:
                continue
            if text.isdecimal():
                limits.append(int(text))
        if folder == CGROUPS:
            break
    return limits
