"""A viewer with a memory, whose pages look back on their own."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest

from tests.support.memory_viewer import Memory


@pytest.fixture
def make(
    tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Callable[..., Memory]]:
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path_factory.mktemp("config")))
    made: list[Memory] = []

    def make(**options: Any) -> Memory:
        made.append(Memory(**options))
        return made[-1]

    yield make
    for memory in made:
        memory.close()


@pytest.fixture
def memory(make: Callable[..., Memory]) -> Memory:
    return make()
