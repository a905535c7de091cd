"""A studio for pictures of the displays."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import playwright.sync_api as playwright
import pytest
from pictures import Stage, Studio

from webviz import Display


@pytest.fixture(scope="session")
def studio(browser: playwright.Browser, request: pytest.FixtureRequest) -> Iterator[Studio]:
    """One tab for all pictures: opening it takes seconds."""
    studio = Studio(browser, update=bool(request.config.getoption("--update-pictures")))
    yield studio
    studio.close()


@pytest.fixture
def stage(studio: Studio) -> Iterator[Callable[..., Stage]]:
    """Sets one stage after another; the page must raise no errors."""
    stages: list[Stage] = []

    def set_up(*displays: Display, **options: Any) -> Stage:
        if stages:
            stages.pop().close()
        stages.append(Stage(studio, *displays, **options))
        return stages[-1]

    yield set_up
    for each in stages:
        each.close()
    assert studio.page.errors == []
