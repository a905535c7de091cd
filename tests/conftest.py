"""What tests of several folders share."""

from __future__ import annotations

from collections.abc import Iterator

import playwright.sync_api as playwright
import pytest
from page import launched


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--update-pictures",
        action="store_true",
        help="make the reference pictures of tests/pictures anew; look at each before committing",
    )


@pytest.fixture(scope="session")
def browser() -> Iterator[playwright.Browser]:
    """One headless Chromium for all tests."""
    with launched() as browser:
        yield browser
