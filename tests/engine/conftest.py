"""Fixtures shared by tests of the pipeline."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from bench import Benches, benches


@pytest.fixture
def bench() -> Iterator[Benches]:
    """Make a viewer of displays."""
    with benches() as make:
        yield make
