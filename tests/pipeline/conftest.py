"""Fixtures shared by tests of the pipeline."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
from bench import Bench, benches


@pytest.fixture
def bench() -> Iterator[Callable[..., Bench]]:
    """Make a viewer of displays."""
    with benches() as make:
        yield make
