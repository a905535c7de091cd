"""A ROS domain that is unused on this machine."""

from __future__ import annotations

import os
import random
import socket
from collections.abc import Iterator
from contextlib import contextmanager

DOMAINS = range(1, 100)
"""The ports of domains above 101 are in Linux's ephemeral range."""
FIRST_PORT, PORTS = 7400, 250
"""In DDS, domain d has the UDP ports from 7400 + 250 d."""
PARTICIPANTS = range(10, 30, 2)
"""Offsets of the ports of the first participants on a machine; the first may have left."""
UNUSED = 249
"""Offset of a port that only the 120th participant would use; bound as a lock."""


@contextmanager
def isolated_domain() -> Iterator[int]:
    """Provide an unused domain, also for processes that are started during the block.

    Raises:
        RuntimeError: all domains are in use.
    """
    lock, domain = _take()
    ours = {"ROS_DOMAIN_ID": str(domain), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    before = {name: os.environ.get(name) for name in ours}
    os.environ |= ours
    try:
        yield domain
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value
        lock.close()


def _take() -> tuple[socket.socket, int]:
    for domain in random.SystemRandom().sample(DOMAINS, len(DOMAINS)):
        first = FIRST_PORT + PORTS * domain
        lock = _bound(first + UNUSED)
        if lock is None:
            continue
        if all(_is_free(first + offset) for offset in PARTICIPANTS):
            return lock, domain
        lock.close()
    raise RuntimeError("All ROS domains of this machine are in use. Stop some ROS programs.")


def _is_free(port: int) -> bool:
    probe = _bound(port)
    if probe is not None:
        probe.close()
    return probe is not None


def _bound(port: int) -> socket.socket | None:
    """Return a UDP socket bound to a port, or None if the port is in use."""
    candidate = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        candidate.bind(("", port))
    except OSError:
        candidate.close()
        return None
    return candidate
