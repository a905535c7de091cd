"""Programs as a user starts them, on a ROS domain of their own."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from typing import Any

import playwright.sync_api as playwright
import pytest
from program import Program

from webviz.shell.pictures.browser import Page
from webviz.shell.testing.domain import isolated_domain


@pytest.fixture(scope="module")
def ros_env() -> Iterator[dict[str, str]]:
    """The environment of programs that meet only each other."""
    with isolated_domain():
        yield {**os.environ, "PYTHONUNBUFFERED": "1"}


@pytest.fixture(scope="module")
def start(
    ros_env: dict[str, str], tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Callable[..., Program]]:
    """Start `python -m` with arguments; whatever still runs at the end is ended."""
    programs: list[Program] = []

    def start(*arguments: str, env: dict[str, str] | None = None) -> Program:
        log = tmp_path_factory.mktemp("log") / "output.txt"
        command = [sys.executable, "-m", *arguments]
        own = {"XDG_STATE_HOME": str(log.parent), **(env or {})}  # nothing is restored
        programs.append(Program(command, {**ros_env, **own}, log))
        return programs[-1]

    yield start
    for program in reversed(programs):
        program.end()


@pytest.fixture(scope="module")
def view(
    start: Callable[..., Program],
    browser: playwright.Browser,
    tmp_path_factory: pytest.TempPathFactory,
) -> Iterator[Callable[..., Page]]:
    """Start a viewer with a config, and open a page that draws only when it is looked at.

    A graphics card in software is slow. Neither the page nor the viewer may have failed in the end.
    """
    opened: list[tuple[Page, Program]] = []

    def view(config: str, *arguments: str, height: int = 500, resolution: float = 1.0) -> Page:
        path = tmp_path_factory.mktemp("config") / "config.yaml"
        path.write_text(config)
        program = start("webviz", "-d", str(path), "--port", "0", *arguments)
        page = Page(browser, program.url(), 900, height, resolution=resolution)
        opened.append((page, program))
        page.hold()
        return page

    yield view
    assert [page.errors for page, _ in opened] == [[]] * len(opened)
    for page, program in opened:
        page.close()
        assert program.end() == 0, program.output()
        assert "Traceback" not in program.output()


@pytest.fixture
def open_page(browser: playwright.Browser) -> Iterator[Callable[..., Page]]:
    """Open a viewer in a tab; pages must raise no errors."""
    pages: list[Page] = []

    def open_page(url: str, width: int = 900, height: int = 500, resolution: float = 1.0) -> Page:
        pages.append(Page(browser, url, width, height, resolution=resolution))
        return pages[-1]

    yield open_page
    errors: list[Any] = []
    for page in pages:
        errors += page.errors
        page.close()
    assert errors == []
