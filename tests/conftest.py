"""What tests of several folders share."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from importlib.metadata import entry_points
from pathlib import Path

import playwright.sync_api as playwright
import pytest
from hypothesis import settings

from webviz.shell.pictures.browser import NoBrowser, launched

# An example is not wrong because the machine was busy.
settings.register_profile("untimed", deadline=None)
settings.load_profile("untimed")


def pytest_configure() -> None:
    """An editable installation has the entry points of the day it was made."""
    tree = ast.parse((Path(__file__).parent.parent / "setup.py").read_text())
    calls = (node for node in ast.walk(tree) if isinstance(node, ast.Call))
    (declared,) = (k.value for c in calls for k in c.keywords if k.arg == "entry_points")
    for group, lines in ast.literal_eval(declared).items():
        installed = {f"{point.name} = {point.value}" for point in entry_points(group=group)}
        if not installed.issuperset(lines):
            raise pytest.UsageError("setup.py has entry points that are not installed: run make.")


@pytest.fixture(scope="session")
def browser() -> Iterator[playwright.Browser]:
    """One headless Chromium for all tests of pages."""
    try:
        with launched() as browser:
            yield browser
    except NoBrowser as error:
        pytest.fail(str(error), pytrace=False)
