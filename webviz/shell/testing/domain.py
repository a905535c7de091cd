"""A ROS domain that is unused on this machine."""

from __future__ import annotations

import os
import random
from collections.abc import Iterator
from contextlib import contextmanager

from webviz.shell.domains import DOMAINS, reserve

UNUSED = 249
"""Offset of a port that only the 120th participant would use; bound as a lock."""


@contextmanager
def isolated_domain() -> Iterator[int]:
    """Provide an unused domain, also for processes that are started during the block.

    Raises:
        Error: all domains are in use.
    """
    lock, domain = reserve(random.SystemRandom().sample(DOMAINS, len(DOMAINS)), UNUSED)
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
