"""Programs of ROS on this machine that share its network, but not its memory."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

PROC = Path("/proc")
LIBRARIES = (b"librmw", b"libfastrtps", b"libfastdds", b"libddsc")
"""Of programs that are ROS nodes."""
MOST = 10
LONGEST = 80
"""Characters of a command line that are shown."""


def programs_apart(memory: Path) -> Sequence[str]:
    """Return the command lines of ROS programs of this domain with other shared memory.

    A container with the network of the host (`--network host`) has its own unless it is started
    with `--ipc=host`. Fast DDS takes it for the same machine, and sends through shared memory.

    Args:
        memory: the file system of shared memory.
    """
    try:
        own, network = os.stat(memory).st_dev, os.readlink(PROC / "self/ns/net")
    except OSError:
        return ()
    found: list[str] = []
    domain = os.environ.get("ROS_DOMAIN_ID") or "0"
    for process in PROC.glob("[0-9]*"):
        try:
            if os.stat(f"{process}/root{memory}").st_dev == own:
                continue
            if os.readlink(process / "ns/net") != network:
                continue
            maps = (process / "maps").read_bytes()
            words = (process / "cmdline").read_bytes().replace(b"\0", b" ")
            if _domain(process) != domain:
                continue
        except OSError:  # it has ended, or belongs to another user
            continue
        if any(library in maps for library in LIBRARIES):
            found.append(words.decode(errors="replace").strip()[:LONGEST])
    return tuple(sorted(found)[:MOST])


def _domain(process: Path) -> str:
    """Return the domain of ROS in the environment that a process was started with."""
    entries = (process / "environ").read_bytes().split(b"\0")
    named = (each for each in entries if each.startswith(b"ROS_DOMAIN_ID="))
    return next(named, b"").partition(b"=")[2].decode(errors="replace") or "0"
