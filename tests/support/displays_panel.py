"""Actions of a person at the side of a page, in tests of whole programs."""

from __future__ import annotations

import contextlib

import playwright.sync_api as playwright
import pytest

from webviz.shell.pictures.browser import Page

GLOBAL_OPTIONS = "Global Options"
PATIENCE_S = 60.0
SELECTED_S = 5.0
"""Time in seconds in which a page shows what a click selected."""


class DisplaysPanel:
    """The panel Displays of a page."""

    def __init__(self, page: Page) -> None:
        self.page = page
        self.tab = page.tab
        self.properties = page.tab.get_by_role("region", name="Properties", exact=True)

    def select(self, name: str) -> None:
        """Click on a display, again if a card above the list has moved another one there."""
        row = self.tab.get_by_role("treeitem", name=name, exact=True)
        heading = self.properties.get_by_role("heading").and_(
            self.tab.get_by_text(name, exact=True)
        )

        def is_selected() -> bool:
            row.click(timeout=PATIENCE_S * 1000)
            with contextlib.suppress(playwright.TimeoutError):
                heading.wait_for(timeout=SELECTED_S * 1000)
            return heading.is_visible()

        self.page.wait_for(is_selected, f"the properties of {name}", PATIENCE_S)

    def field(self, path: str) -> playwright.Locator:
        """The control of a property of the selected display."""
        return self.properties.locator(f"[data-path='{path}']").locator("input").first

    def text(self) -> str:
        """Statuses, which are folded while all is well, and properties of the selected display."""
        self.properties.evaluate(
            "(side) => side.querySelector('.wv-status-head[aria-expanded=false]')?.click()"
        )
        return self.properties.inner_text()

    def wait_for(self, *words: str, seconds: float = PATIENCE_S) -> None:
        """Wait until the statuses and properties say all of this."""

        def missing() -> list[str]:
            text = self.text()
            return [each for each in words if each not in text]

        try:
            self.page.wait_for(lambda: not missing(), "", seconds)
        except TimeoutError:
            pytest.fail(f"the page lacks {missing()}: {self.text()}")
