"""A plug-in file that is edited, and the viewer that shows it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from webviz.api import registry
from webviz.api.display import Display
from webviz.engine.pipeline.plugins import load

EXAMPLE = Path(__file__).with_name("polygon.py")


class Plugin:
    """A copy of the README's example."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.path.write_text(EXAMPLE.read_text())

    def load(self) -> type[Display]:
        """Load it, and return its only display."""
        (cls,) = load(self.path).values()
        assert issubclass(cls, Display)
        return cls

    def edit(self, *changes: tuple[str, str]) -> None:
        """Replace text in it."""
        text = self.path.read_text()
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        self.path.write_text(text)


@pytest.fixture
def plugin(tmp_path: Path) -> Iterator[Plugin]:
    yield Plugin(tmp_path / "polygon.py")
    for path in tmp_path.rglob("*.py"):
        registry.register(str(path), {})
