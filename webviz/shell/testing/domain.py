"""A ROS domain that nobody else on this machine uses."""

from __future__ import annotations

import os
import random
import socket
from collections.abc import Iterator
from contextlib import contextmanager

DOMAINS = range(1, 100)
"""Above 101 their ports are among those that Linux gives to any program."""
FIRST_PORT, PORTS = 7400, 250
"""Of DDS: domain d has UDP ports from 7400 + 250 d on."""
PARTICIPANT = 10
"""Offset of the port of the first participant of a domain on this machine."""
UNUSED = 249
"""Offset of a port that only the 120th participant would take; ours, as a lock."""


@contextmanager
def isolated_domain() -> Iterator[int]:
    """A domain of one's own, also for processes that are started meanwhile.

    Raises:
        RuntimeError: all are in use.
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
        probe = _bound(first + PARTICIPANT)
        if probe is not None:
            probe.close()
            return lock, domain
        lock.close()
    raise RuntimeError("All ROS domains of this machine are in use: end some ROS programs.")


def _bound(port: int) -> socket.socket | None:
    """A UDP socket at a port, None if it is taken."""
    candidate = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        candidate.bind(("", port))
    except OSError:
        candidate.close()
        return None
    return candidate
