"""Memory that this machine, or the container of this process, has."""

from __future__ import annotations

import os
from functools import cache
from pathlib import Path

CGROUPS = Path("/sys/fs/cgroup")
OWN = Path("/proc/self/cgroup")
LIMITS = ("memory.max", "memory.high")
"""Files of a control group with a limit in bytes, or "max" for none, as the documentation of the
kernel says of cgroup v2."""


@cache
def memory_bytes() -> int | None:
    """Return the bytes of memory that this process may use, None where systems do not tell it."""
    try:
        machine = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, OSError, ValueError):  # Windows
        return None
    return min([machine, *_limits()]) if machine > 0 else None


def _limits() -> list[int]:
    """Return the limits of the control groups that this process is in."""
    try:
        lines = OWN.read_text(encoding="utf-8").splitlines()
    except OSError:
        return []
    own = next((line.removeprefix("0::/") for line in lines if line.startswith("0::/")), None)
    if own is None:
        return []
    group = CGROUPS / own
    found: list[int] = []
    for folder in (group, *group.parents):
        for name in LIMITS:
            try:
                text = (folder / name).read_text(encoding="utf-8").strip()
            except OSError:
                continue
            if text.isdecimal():
                found.append(int(text))
        if folder == CGROUPS:
            break
    return found
