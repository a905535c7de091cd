"""Pages of a viewer in one browser."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import playwright.sync_api as playwright

from webviz.shell.pictures.browser import Page

COARSE = 0.1
"""Pixels of the scene per pixel of the page, for tests that do not look at the scene: to draw it in
full takes most of the time of a browser without a graphics card."""


@contextmanager
def open_pages(
    browser: playwright.Browser,
    url: str,
    width: int,
    height: int,
    count: int = 2,
    resolution: float = COARSE,
) -> Iterator[list[Page]]:
    """Open pages and close them at the end; their scripts must not have failed by then."""
    opened = [Page(browser, url, width, height, resolution=resolution) for _ in range(count)]
    yield opened
    errors = [error for page in opened for error in page.errors]
    for page in opened:
        page.close()
    assert errors == []
