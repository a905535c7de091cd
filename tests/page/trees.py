"""The tree of displays in a tab, as its user sees it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import playwright.sync_api as playwright
from pages import bounds

from tests.page.tabs import ViewerTab
from webviz.api.group import DisplayGroup
from webviz.api.status import Status
from webviz.engine.state import Row


class Tree:
    """The tree of displays in a tab."""

    def __init__(self, tab: ViewerTab) -> None:
        self.tab = tab
        self.details = tab.page.get_by_role("region", name="Properties", exact=True)

    def row(self, name: str) -> playwright.Locator:
        """The row of a display, without its properties."""
        return self.tab.page.get_by_role("treeitem", name=name, exact=True)

    def box(self, name: str) -> playwright.Locator:
        """Its check box."""
        return self.tab.page.get_by_role("checkbox", name=f"Show {name}", exact=True)

    def item(self, label: str) -> playwright.Locator:
        """An item of the menu that is open."""
        return self.tab.page.get_by_role("menuitem", name=label)

    def names(self) -> list[str]:
        """Return the names of the page's rows from top to bottom, but for the global options."""
        rows = self.tab.page.locator(".wv-tree-canvas .wv-tree-node:not([data-id=global])")
        return rows.evaluate_all(
            "rows => rows.sort((a, b) => parseFloat(a.style.top) - parseFloat(b.style.top))"
            ".map(row => row.querySelector('.wv-tree-name').textContent)"
        )

    def wait_for_names(self, *names: str) -> None:
        """Wait until these are the rows."""
        self.tab.wait_for(lambda: self.names() == list(names))

    def selected(self) -> list[str]:
        """The names of the rows that are selected."""
        rows = self.tab.page.locator(".wv-tree-canvas [aria-selected=true] .wv-tree-name")
        return rows.all_text_contents()

    def top(self, name: str) -> float:
        """The top of a row in pixels of the window."""
        box = bounds(self.row(name))
        return box["y"]

    def click(self, name: str, **options: Any) -> None:
        """Click on a name."""
        self.tab.wait_for(lambda: self.row(name).count() == 1)
        self.row(name).locator(".wv-tree-name").click(**options)
        self.tab.turn()

    def press(self, keys: str) -> None:
        """Press keys where the focus is."""
        self.tab.page.keyboard.press(keys)
        self.tab.turn()

    def fold(self, name: str) -> None:
        """Click on the arrow of a row."""
        self.row(name).locator(".wv-tree-fold").click()
        self.tab.turn()

    def drag_by(self, element: playwright.Locator, dx: float, dy: float) -> None:
        """Drag the middle of something by mouse."""
        box = bounds(element)
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        mouse = self.tab.page.mouse
        mouse.move(x, y)
        mouse.down()
        mouse.move(x + dx / 2, y + dy / 2)
        mouse.move(x + dx, y + dy)
        mouse.up()


def group(
    id_: str, depth: int = 0, statuses: Mapping[str, Status] | None = None, enabled: bool = True
) -> Row:
    """A row of a group that is called as its id."""
    display = DisplayGroup(name=id_, enabled=enabled)
    return Row(id_, "Group", display, id_, statuses or {}, depth, enabled)


def height_of(element: playwright.Locator) -> float:
    """Return the height of an element, in pixels."""
    box = bounds(element)
    return box["height"]
