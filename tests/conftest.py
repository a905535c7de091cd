"""What tests of several folders share."""

from __future__ import annotations

from collections.abc import Iterator

import playwright.sync_api as playwright
import pytest

from webviz.shell.pictures.browser import NoBrowser, launched


@pytest.fixture(scope="session")
def browser() -> Iterator[playwright.Browser]:
    """One headless Chromium for all tests of pages."""
    try:
        with launched() as browser:
            yield browser
    except NoBrowser as error:
        pytest.fail(str(error), pytrace=False)
