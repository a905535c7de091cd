"""Viewers as a Python program has them, without ROS."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

import webviz
from webviz.shell.testing.source import HandFedSource


@pytest.fixture
def source() -> HandFedSource:
    return HandFedSource()


@pytest.fixture
def viewer(source: HandFedSource) -> Iterator[webviz.Viewer]:
    """A viewer that shows nothing yet."""
    with webviz.Viewer(port=0, source=source) as viewer:
        viewer.config = {"displays": []}
        yield viewer


@pytest.fixture
def refusal() -> Callable[[Callable[[], object]], str]:
    """The one sentence with which something is refused."""

    def refusal(ask: Callable[[], object]) -> str:
        with pytest.raises(webviz.Error) as error:
            ask()
        assert "\n" not in str(error.value)
        return str(error.value)

    return refusal
