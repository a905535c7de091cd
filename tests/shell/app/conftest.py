"""Viewers as a Python program has them, without ROS."""

from __future__ import annotations

from collections.abc import Iterator

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
