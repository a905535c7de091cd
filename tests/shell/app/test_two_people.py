"""Two people with one viewer, in turns and at once, each in a browser of their own."""

from __future__ import annotations

from collections.abc import Iterator

import playwright.sync_api as playwright
import pytest
from drives import recorded
from pages import open_pages

import webviz
from webviz.files.opening import parse
from webviz.shell.pictures.browser import Page

CONFIG = """
displays:
- {type: Grid}
- {type: Axes}
- {type: TF}
"""


@pytest.fixture(scope="module")
def viewer(tmp_path_factory: pytest.TempPathFactory) -> Iterator[webviz.Viewer]:
    """A viewer of a bag."""
    bag = recorded(duration_s=20.0).write(tmp_path_factory.mktemp("bags") / "run")
    with webviz.Viewer(port=0, bag=bag, read=lambda *_: parse(CONFIG, "x.yaml")) as viewer:
        yield viewer


@pytest.fixture(scope="module")
def pages(browser: playwright.Browser, viewer: webviz.Viewer) -> Iterator[list[Page]]:
    with open_pages(browser, viewer.url, 900, 600) as open_tabs:
        yield open_tabs


def row(page: Page, name: str) -> playwright.Locator:
    return page.tab.get_by_role("treeitem", name=name, exact=True)


def wait_for(pages: list[Page], *names: str) -> None:
    """Wait until both pages list exactly these displays."""
    script = "(all) => all.map((one) => one.textContent)"
    for page in pages:
        names_on_page = page.tab.locator(".wv-tree-node:not([data-id=global]) .wv-tree-name")
        page.wait_for(
            lambda names_on_page=names_on_page: (
                sorted(names_on_page.evaluate_all(script)) == sorted(names)
            ),
            str(names),
        )


def test_each_page_undoes_its_own_steps_and_a_restored_display_is_selected(
    pages: list[Page],
) -> None:
    mine, theirs = pages
    wait_for(pages, "Grid", "Axes", "TF")
    row(mine, "Grid").locator(".wv-tree-name").click()
    mine.tab.keyboard.press("Delete")
    wait_for(pages, "Axes", "TF")
    element = theirs.tab.get_by_role("checkbox", name="Show Axes")
    element.uncheck()
    mine.wait_for(lambda: not mine.tab.get_by_role("checkbox", name="Show Axes").is_checked(), "it")

    mine.tab.keyboard.press("Control+z")
    wait_for(pages, "Grid", "Axes", "TF")
    assert not element.is_checked()  # the change of the other
    playwright.expect(row(mine, "Grid")).to_have_attribute("aria-selected", "true")
    mine.tab.keyboard.press("Delete")
    wait_for(pages, "Axes", "TF")

    theirs.tab.keyboard.press("Control+z")
    theirs.wait_for(element.is_checked, "the undone change")
    wait_for(pages, "Axes", "TF")


def test_both_drag_the_head_at_once_and_end_at_the_same_moment(
    viewer: webviz.Viewer, pages: list[Page]
) -> None:
    tracks = [page.tab.get_by_role("slider", name="recording") for page in pages]
    boxes = [track.bounding_box() for track in tracks]
    for step in range(12):
        for page, box, share in zip(
            pages, boxes, (0.1 + 0.05 * step, 0.9 - 0.05 * step), strict=True
        ):
            assert box is not None
            page.tab.mouse.move(box["x"] + share * box["width"], box["y"] + box["height"] / 2)
            if step == 0:
                page.tab.mouse.down()
    for page in pages:
        page.tab.mouse.up()

    def positions() -> list[float]:
        """The positions of the viewer and of both pages."""
        values = [float(track.get_attribute("aria-valuenow") or -1.0) for track in tracks]
        return [round(viewer.position, 2), *(round(value, 2) for value in values)]

    mine = pages[0]
    mine.wait_for(lambda: len(set(positions())) == 1, "one moment")
    assert 6.0 < viewer.position < 14.0, "where one of them let go"
    tracks[1].click(position={"x": 20.0, "y": 5.0})
    mine.wait_for(lambda: viewer.position < 2.0 and len(set(positions())) == 1, "the next seek")
