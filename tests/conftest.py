"""Fixtures shared by tests of several folders."""

from __future__ import annotations

import ast
import atexit
import fcntl
import gc
import os
import shutil
import tempfile
from collections.abc import Generator, Iterator
from importlib.metadata import entry_points
from pathlib import Path
from typing import Any

import playwright.sync_api as playwright
import pytest
from hypothesis import settings
from xdist.remote import Producer
from xdist.scheduler import LoadFileScheduling

from webviz.shell.pictures.browser import PATIENCE_S, NoBrowser, launched

# An example is not wrong because the machine was busy, and what fails must fail for everybody. New
# examples are looked for with --hypothesis-profile=explore.
settings.register_profile("explore", deadline=None, max_examples=1000)
settings.register_profile("same", deadline=None, derandomize=True)
settings.load_profile("same")

EXPECTED = (
    "WebSocket connection to",
    "Failed to load resource",
    "THREE.BufferGeometry.computeBoundingSphere(): Computed radius is NaN.",
)
"""Messages of Chromium when a server is gone, and of three.js about points that are not finite,
which some tests provoke."""

JAGGED = """{
  const get = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function (kind, options) {
    return get.call(this, kind, kind === "2d" ? options : { ...options, antialias: false });
  };
}"""
"""Draws scenes without smooth edges, which take a third of the time of a browser without a graphics
card."""

CALM = """{
  const FRAME_MS = 100;
  const request = window.requestAnimationFrame.bind(window);
  const waiting = new Map();
  let count = 0;
  let last = 0;
  let isDue = false;
  // Each in a callback of its own, after which the browser does what React has left to do.
  const run = (number) => request((now) => {
    last = now;
    const draw = waiting.get(number);
    if (waiting.delete(number)) draw(now);
  });
  window.requestAnimationFrame = (draw) => {
    waiting.set(++count, draw);
    const wait = () => {
      isDue = false;
      [...waiting.keys()].forEach(run);
    };
    if (!isDue) setTimeout(wait, Math.max(0, last + FRAME_MS - performance.now()));
    isDue = true;
    return count;
  };
  window.cancelAnimationFrame = (number) => waiting.delete(number);
}"""
"""Draws at most ten frames a second: without a graphics card, the 60 of a robot that moves take a
whole processor."""


SHARING = ("tests/shell/pictures", "tests/page", "tests/pictures", "tests/scene")
"""Folders whose tests share tabs: each process that runs some of them opens the tabs for itself."""


class FolderScheduling(LoadFileScheduling):
    """Gives a process all tests of a file, or of a folder whose tests share tabs."""

    def _split_scope(self, nodeid: str) -> str:
        file = super()._split_scope(nodeid)
        folder = file.rpartition("/")[0]
        return folder if folder in SHARING else file


def pytest_xdist_make_scheduler(config: pytest.Config, log: Producer) -> FolderScheduling:
    """Distribute tests to processes."""
    return FolderScheduling(config, log)


def pytest_configure() -> None:
    """Check the installation, and give viewers that tests start a folder of their own."""
    _check_entry_points()
    gc.set_threshold(20_000, 20, 20)
    os.environ["XDG_STATE_HOME"] = tempfile.mkdtemp(prefix="webviz-tests-")
    atexit.register(shutil.rmtree, os.environ["XDG_STATE_HOME"], ignore_errors=True)


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(collector: pytest.Collector) -> Generator[None, Any, Any]:
    """Let one process compile a test file, which takes longer than to load it, for the others."""
    if not isinstance(collector, pytest.Module):
        return (yield)
    with collector.path.open() as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        return (yield)


def pytest_collection_finish() -> None:
    """Never let the garbage collector look at what was imported: that takes a sixth."""
    gc.collect()
    gc.freeze()


def _check_entry_points() -> None:
    """An editable installation has the entry points of the day it was made."""
    tree = ast.parse((Path(__file__).parent.parent / "setup.py").read_text())
    calls = (node for node in ast.walk(tree) if isinstance(node, ast.Call))
    (declared,) = (k.value for c in calls for k in c.keywords if k.arg == "entry_points")
    for group, lines in ast.literal_eval(declared).items():
        installed = {f"{point.name} = {point.value}" for point in entry_points(group=group)}
        if not installed.issuperset(lines):
            raise pytest.UsageError("setup.py has entry points that are not installed: run make.")


@pytest.fixture(scope="session")
def said_on_consoles() -> list[str]:
    """Errors of all pages, and warnings of our modules."""
    return []


@pytest.fixture(scope="session")
def browser(said_on_consoles: list[str]) -> Iterator[playwright.Browser]:
    """One headless Chromium for all tests of pages.

    Its contexts have two options more: `smooth=True` is for pictures, `every_frame=True` for
    gestures that are shorter than a frame.
    """

    def hear(message: playwright.ConsoleMessage) -> None:
        is_ours = "/webviz/" in message.location.get("url", "")
        is_bad = message.type == "error" or (message.type == "warning" and is_ours)
        if is_bad and not message.text.startswith(EXPECTED):
            said_on_consoles.append(message.text)

    def new_context(
        smooth: bool = False, every_frame: bool = False, **options: Any
    ) -> playwright.BrowserContext:
        context = make(**options)
        if not smooth:
            context.add_init_script(JAGGED)
        if not every_frame:
            context.add_init_script(CALM)
        context.set_default_timeout(1000.0 * PATIENCE_S)
        context.on("console", hear)
        context.on("weberror", lambda error: said_on_consoles.append(str(error.error)))
        return context

    try:
        with launched() as browser:
            playwright.expect.set_options(timeout=1000.0 * PATIENCE_S)
            make = browser.new_context
            browser.new_context = new_context
            yield browser
    except NoBrowser as error:
        pytest.fail(str(error), pytrace=False)


@pytest.fixture(autouse=True)
def quiet_consoles(said_on_consoles: list[str]) -> Iterator[None]:
    """No test makes a page report an error."""
    yield
    lines, said_on_consoles[:] = tuple(said_on_consoles), ()
    assert not lines
