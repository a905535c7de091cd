"""What tests of several folders share."""

from __future__ import annotations

from collections.abc import Iterator

import playwright.sync_api as playwright
import pytest
from hypothesis import settings

from webviz.shell.pictures.browser import NoBrowser, launched

# An example is not wrong because the machine was busy.
settings.register_profile("untimed", deadline=None)
settings.load_profile("untimed")


@pytest.fixture(scope="session")
def browser() -> Iterator[playwright.Browser]:
    """One headless Chromium for all tests of pages."""
    try:
        with launched() as browser:
            yield browser
    except NoBrowser as error:
        pytest.fail(str(error), pytrace=False)
