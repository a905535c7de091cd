"""Two people who change the displays of one viewer in turns, each in a browser of their own."""

from __future__ import annotations

from collections.abc import Iterator

import playwright.sync_api as playwright
import pytest
from pages import open_pages

import webviz
from webviz.files.config import Config
from webviz.files.opening import parse
from webviz.shell.pictures.browser import Page
from webviz.shell.testing.source import HandFedSource

CONFIG = """
displays:
- {type: Grid}
- {type: Axes}
- {type: TF}
"""


@pytest.fixture
def pages(browser: playwright.Browser) -> Iterator[list[Page]]:
    def read(*_: object) -> Config:
        return parse(CONFIG, "x.yaml")

    with (
        webviz.Viewer(port=0, source=HandFedSource(), read=read) as viewer,
        open_pages(browser, viewer.url, 900, 600) as opened,
    ):
        yield opened


def row(page: Page, name: str) -> playwright.Locator:
    return page.tab.get_by_role("treeitem", name=name, exact=True)


def wait_for(pages: list[Page], *names: str) -> None:
    """Wait until both pages list exactly these displays."""
    script = "(all) => all.map((one) => one.textContent)"
    for page in pages:
        found = page.tab.locator(".wv-tree-node:not([data-id=global]) .wv-tree-name")
        page.wait_for(
            lambda found=found: sorted(found.evaluate_all(script)) == sorted(names), str(names)
        )


def test_each_takes_back_their_own_and_delete_is_about_what_came_back(pages: list[Page]) -> None:
    mine, theirs = pages
    wait_for(pages, "Grid", "Axes", "TF")
    row(mine, "Grid").locator(".wv-tree-name").click()
    mine.tab.keyboard.press("Delete")
    wait_for(pages, "Axes", "TF")
    shown = theirs.tab.get_by_role("checkbox", name="Show Axes")
    shown.uncheck()
    mine.wait_for(lambda: not mine.tab.get_by_role("checkbox", name="Show Axes").is_checked(), "it")

    mine.tab.keyboard.press("Control+z")
    wait_for(pages, "Grid", "Axes", "TF")
    assert not shown.is_checked()  # the change of the other
    playwright.expect(row(mine, "Grid")).to_have_attribute("aria-selected", "true")
    mine.tab.keyboard.press("Delete")
    wait_for(pages, "Axes", "TF")

    theirs.tab.keyboard.press("Control+z")
    theirs.wait_for(shown.is_checked, "the undone change")
    wait_for(pages, "Axes", "TF")
