"""A router, a robot on it, and a source that reads it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack

import pytest
from waiting import until
from zenoh_robot import ZenohRobot, ZenohRouter

from webviz.sources.zenoh.address import zenoh_address
from webviz.sources.zenoh.source import ZenohSource


@pytest.fixture
def stack() -> Iterator[ExitStack]:
    """Closes at the end what a test has opened."""
    with ExitStack() as stack:
        yield stack


@pytest.fixture
def router() -> Iterator[ZenohRouter]:
    router = ZenohRouter()
    yield router
    router.close()


@pytest.fixture
def robot(router: ZenohRouter) -> Iterator[ZenohRobot]:
    robot = ZenohRobot(router.endpoint)
    yield robot
    robot.close()


@pytest.fixture
def source(router: ZenohRouter) -> Iterator[ZenohSource]:
    source = ZenohSource(zenoh_address(router.endpoint, {}))
    until(lambda: source.bridges[0].is_up)
    yield source
    source.close()
