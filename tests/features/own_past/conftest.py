"""A viewer with a memory, whose pages look back on their own."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
from several import several

from tests.support.memory_viewer import MemoryViewer


@pytest.fixture
def make(
    tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Callable[..., MemoryViewer]]:
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path_factory.mktemp("config")))
    with several(MemoryViewer) as make:
        yield make


@pytest.fixture
def memory(make: Callable[..., MemoryViewer]) -> MemoryViewer:
    return make()
