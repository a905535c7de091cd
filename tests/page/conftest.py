"""A server, its pages, and real browsers."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import playwright.sync_api as playwright
import pytest
from pages import COARSE

from tests.page.page_bench import PageBench, PageServer
from tests.page.tabs import HEIGHT, WIDTH, ViewerTab, open_page

TIDY = """() => {
  document.querySelectorAll("#bench").forEach((one) => one.remove());
  document.querySelectorAll(".wv-toast [aria-label=Dismiss]").forEach((one) => one.click());
  document.activeElement?.blur();
  localStorage.clear();
}"""
"""Removes what tests put beside the panels, and forgets widths and folds."""

DISMISS = """() => document.querySelectorAll(".wv-toast [aria-label=Dismiss]").forEach(
  (one) => one.click(),
)"""
"""Removes toasts, which would lie over what another test clicks."""


def tidy_up(tab: ViewerTab) -> None:
    """Have a tab as it was at first, whatever another module has done to it."""
    page = tab.page
    page.set_viewport_size({"width": WIDTH, "height": HEIGHT})
    page.mouse.up()
    page.mouse.move(WIDTH - 1, HEIGHT - 1)
    page.keyboard.press("Escape")
    tab.show_tab("Displays")


@pytest.fixture(scope="package")
def page_server(browser: playwright.Browser) -> Iterator[PageServer]:
    """One server for the viewers of all tests, and thereby for their tab."""
    page_server = PageServer()
    yield page_server
    page_server.close()


@pytest.fixture(scope="package")
def lasting_viewer_tab(page_server: PageServer, browser: playwright.Browser) -> Iterator[ViewerTab]:
    """The tab of all these tests."""
    tab = ViewerTab(open_page(browser), page_server)
    yield tab
    tab.page.context.close()


@pytest.fixture(scope="module")
def tidy_viewer_tab(page_server: PageServer, lasting_viewer_tab: ViewerTab) -> ViewerTab:
    """The same as it was at first."""
    tab = lasting_viewer_tab
    page_server.begin()
    tidy_up(tab)
    tab.catch_up()
    tab.page.evaluate(TIDY)
    return tab


@pytest.fixture
def viewer(page_server: PageServer, tidy_viewer_tab: ViewerTab) -> PageBench:
    """A viewer without displays, which the tab shows."""
    viewer = page_server.begin()
    tidy_viewer_tab.catch_up()  # else it may lose what a test before has left there
    tidy_viewer_tab.page.evaluate(DISMISS)
    viewer.forget_commands()
    return viewer


@pytest.fixture
def viewer_tab(
    page_server: PageServer, viewer: PageBench, tidy_viewer_tab: ViewerTab
) -> Iterator[ViewerTab]:
    """The tab of the viewer; neither may see an error."""
    tab = tidy_viewer_tab
    yield tab
    errors, tab.errors, page_server.errors = [*tab.errors, *page_server.errors], [], []
    assert errors == []


@contextmanager
def tabs_of(
    browser: playwright.Browser, page_server: PageServer
) -> Iterator[Callable[..., ViewerTab]]:
    """Open more tabs, each in a browser session of its own; they must not see an error."""
    tabs: list[ViewerTab] = []

    def open_tab(
        width: int = WIDTH,
        height: int = HEIGHT,
        resolution: float = COARSE,
        query: str = "",
        **options: Any,
    ) -> ViewerTab:
        page = open_page(browser, width, height, **options)
        tabs.append(ViewerTab(page, page_server, resolution, query))
        return tabs[-1]

    yield open_tab
    errors = [error for tab in tabs for error in tab.errors]
    for tab in tabs:
        tab.page.context.close()
    assert errors == []


@pytest.fixture
def open_viewer_tab(
    browser: playwright.Browser, page_server: PageServer
) -> Iterator[Callable[..., ViewerTab]]:
    """Open more tabs of the viewer for one test."""
    with tabs_of(browser, page_server) as open_tab:
        yield open_tab


@pytest.fixture(scope="module")
def open_lasting_viewer_tab(
    browser: playwright.Browser, page_server: PageServer
) -> Iterator[Callable[..., ViewerTab]]:
    """Open more tabs of the viewer for the tests of a module."""
    with tabs_of(browser, page_server) as open_tab:
        yield open_tab
