"""Programs as a user starts them, on a ROS domain of their own."""

from __future__ import annotations

import logging
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from logging.handlers import QueueHandler
from queue import SimpleQueue
from typing import Any

import playwright.sync_api as playwright
import pytest
from program import Program

import webviz
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
    ros_env: dict[str, str], browser: playwright.Browser, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Callable[..., Page]]:
    """Start a viewer with a config, and open a page that draws only when it is looked at.

    A graphics card in software is slow. Neither the page nor the viewer may have failed in the end.
    """
    pages: list[Page] = []
    failures = SimpleQueue[logging.LogRecord]()
    log = QueueHandler(failures)
    log.setLevel(logging.ERROR)

    def view(config: str, *arguments: str, height: int = 500, resolution: float = 1.0) -> Page:
        path = tmp_path_factory.mktemp("config") / "config.yaml"
        path.write_text(config)
        viewer = viewers.enter_context(webviz.Viewer(path, port=0, ros_args=arguments))
        pages.append(Page(browser, viewer.url, 900, height, resolution=resolution))
        viewers.callback(pages[-1].close)
        pages[-1].hold()
        return pages[-1]

    with ExitStack() as viewers:
        logging.getLogger("webviz").addHandler(log)
        viewers.callback(logging.getLogger("webviz").removeHandler, log)
        yield view
    assert [page.errors for page in pages] == [[]] * len(pages)
    assert failures.empty(), failures.get()


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
