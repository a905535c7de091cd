"""A viewer with a memory, whose pages look back on their own."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
from several import several

from tests.support.memory_viewer import Memory


@pytest.fixture
def make(
    tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Callable[..., Memory]]:
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path_factory.mktemp("config")))
    with several(Memory) as make:
        yield make


@pytest.fixture
def memory(make: Callable[..., Memory]) -> Memory:
    return make()
