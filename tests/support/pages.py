"""Pages of a viewer in one browser."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import playwright.sync_api as playwright

from webviz.shell.pictures.browser import Page
from webviz.shell.pictures.browser_scripts import VISER

COARSE = 0.1
"""Pixels of the scene per pixel of the page, for tests that do not look at the scene: to draw it in
full takes most of the time of a browser without a graphics card."""

VISIBLE = f"async () => {{ {VISER} viser.canvas().style.visibility = ''; }}"


def let_mouse_in(page: Page) -> None:
    """Let a mouse find the scene of a page that is held, which still draws only in `pixels`."""
    page.evaluate(VISIBLE)


def bounds(element: playwright.Locator) -> playwright.FloatRect:
    """Return the bounding box of an element that is on the page, in pixels."""
    box = element.bounding_box()
    assert box is not None
    return box


KEYS = """async () => {
  const { install } = await import("webviz/commands.js");
  if (!window.hasKeys) install();
  window.hasKeys = true;
}"""


def let_keys_in(page: Page) -> None:
    """Have a scene without panels listen to keys, as it does beside them."""
    page.evaluate(KEYS)


@contextmanager
def open_pages(
    browser: playwright.Browser,
    url: str,
    width: int,
    height: int,
    count: int = 2,
    resolution: float = COARSE,
) -> Iterator[list[Page]]:
    """Open pages and close them at the end; their scripts must not have failed by then.

    They draw the scene only in `pixels`, although a mouse finds it.
    """
    open_tabs = [Page(browser, url, width, height, resolution=resolution) for _ in range(count)]
    for page in open_tabs:
        page.hold()
        let_mouse_in(page)
    yield open_tabs
    errors = [error for page in open_tabs for error in page.errors]
    for page in open_tabs:
        page.close()
    assert errors == []
