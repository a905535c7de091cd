"""A display at work under a short name."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest


@pytest.fixture
def bench(webviz_bench: Callable[..., Any]) -> Callable[..., Any]:
    """Make a `DisplayBench` of a display."""
    return webviz_bench
