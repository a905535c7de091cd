"""Unused ROS domains of this machine, and one for each demo."""

from __future__ import annotations

import os
import socket
from collections.abc import Iterable, Iterator
from contextlib import contextmanager

from webviz.api.errors import Error

VARIABLE = "ROS_DOMAIN_ID"
DOMAINS = range(1, 100)
"""The ports of domains above 101 are in Linux's ephemeral range."""
FIRST_PORT, PORTS = 7400, 250
"""UDP ports of DDS: domain d has those from 7400 + 250 d."""
PARTICIPANTS = range(10, 30, 2)
"""Offsets of the ports of the first participants on a machine; the first may have left."""
DEMO = 9
"""Offset of a port that DDS never uses; bound as a lock by demos."""
MOVED = "webviz: another demo runs on this machine, so this one is in its own ROS domain: {}={}"
MIXED = "webviz: another demo runs in this ROS domain, so the robots of both mix: set another {}"


@contextmanager
def demo_domain() -> Iterator[str]:
    """Keep the robots of demos on this machine apart during the block.

    A second demo in the default domain takes an unused one, also for processes that are started
    during the block. A domain that the environment names stays.

    Yields:
        A sentence about another demo, or "".

    Raises:
        Error: all domains are in use.
    """
    named = os.environ.get(VARIABLE, "")
    lock = _bound(FIRST_PORT + PORTS * (int(named) if named.isdecimal() else 0) + DEMO)
    if lock is None and not named:
        lock, domain = reserve(DOMAINS, DEMO)
        os.environ[VARIABLE] = str(domain)
        remark = MOVED.format(VARIABLE, domain)
    else:
        remark = "" if lock else MIXED.format(VARIABLE)
    try:
        yield remark
    finally:
        if not named:
            os.environ.pop(VARIABLE, None)
        if lock is not None:
            lock.close()


def reserve(domains: Iterable[int], offset: int) -> tuple[socket.socket, int]:
    """Reserve the first unused domain until the socket is closed.

    Args:
        domains: to choose from.
        offset: of the port in the domain which is bound as a lock.

    Raises:
        Error: all are in use.
    """
    for domain in domains:
        first = FIRST_PORT + PORTS * domain
        lock = _bound(first + offset)
        if lock is None:
            continue
        if all(_is_free(first + each) for each in PARTICIPANTS):
            return lock, domain
        lock.close()
    raise Error("All ROS domains of this machine are in use. Stop some ROS programs.")


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
    except (OSError, OverflowError):  # in use, or of a domain that DDS does not have
        candidate.close()
        return None
    return candidate
