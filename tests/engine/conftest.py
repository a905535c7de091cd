"""Fixtures shared by tests of the pipeline."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from bench import Bench, Benches, benches
from dots import PoseDot


@pytest.fixture
def bench() -> Iterator[Benches]:
    """Make a viewer of displays."""
    with benches() as make:
        yield make


@pytest.fixture
def b(bench: Benches) -> Bench:
    """A viewer of one dot."""
    return bench(PoseDot(name="Dot"))
