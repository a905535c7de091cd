"""Bug reports made on the page, and opened again."""

from __future__ import annotations

import contextlib
from pathlib import Path

import playwright.sync_api as playwright
import pytest
import stories
from pages import COARSE
from playwright.sync_api import expect

import webviz
from webviz.api.views import Orbit
from webviz.files.report import UnpackedReport, read_report
from webviz.shell.cli.open import show
from webviz.shell.pictures.browser import Page

AT_S = 5.0


def open_viewer(bag: Path, config: Path) -> webviz.Viewer:
    return webviz.Viewer(config, port=0, bag=bag)


def report_a_bug(page: Page) -> None:
    """Report a bug as a user does, with two clicks on Save at once."""
    page.tab.get_by_role("button", name="Menu", exact=True).click()
    page.tab.get_by_role("menuitem", name="Report a bug…").click()
    dialog = page.tab.get_by_role("dialog")
    expect(dialog.get_by_role("listitem").first).to_contain_text("slice.mcap: 6.0 s of ")
    dialog.get_by_role("button", name="Save").dblclick()
    expect(dialog).to_be_hidden()


def has_distance(viewer: webviz.Viewer, distance: float) -> bool:
    views = viewer.state.views.values()
    return [isinstance(v, Orbit) and abs(v.distance - distance) < 1e-3 for v in views] == [True]


def report_of_moment(
    viewer: webviz.Viewer, browser: playwright.Browser, folder: Path
) -> UnpackedReport:
    """A report of a moment, of which a point of the scan is selected."""
    viewer.seek(AT_S)
    with contextlib.closing(Page(browser, viewer.url, 1100, 700)) as page:
        page.wait_for(lambda: viewer["Scan"].status.level is webviz.Level.WARN, "the finding")
        page.wait_for(lambda: has_distance(viewer, Orbit().distance), "its first view")
        page.settle()
        viewer.view = Orbit(distance=6.0, pitch=1.5, focal_point=(-2.0, 0.0, 0.0))
        page.wait_for(lambda: has_distance(viewer, 6.0), "the view")
        page.settle()  # a click goes to what the page has drawn
        page.tab.keyboard.press("s")
        page.tab.mouse.click(*page.pixel_of(-2.0, 0.0))
        page.wait_for(lambda: any(viewer.state.selected.values()), "a selection")
        report_a_bug(page)
        assert page.errors == []
    (path,) = folder.glob("webviz_report_*.zip")
    (out := folder / "out").mkdir()
    return read_report(path, out)


def test_a_report_of_the_page_opens_as_it_was(
    browser: playwright.Browser, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    bag = stories.write(tmp_path / "turned", "turned")
    (config := tmp_path / "lab.yaml").write_text(stories.CONFIG)
    with open_viewer(bag, config) as viewer:
        result = report_of_moment(viewer, browser, tmp_path)
    assert result.picture is not None
    assert result.picture.suffix == ".jpg"
    assert result.report.selection
    # Browsers of tests draw in software, which is a finding of its own.
    assert [each.id for each in result.report.findings if each.id != "WEB002"] == ["DATA001"]
    with open_viewer(result.bag, result.config) as viewer:
        show(viewer, result.report)
        assert viewer.position == pytest.approx(AT_S)
        assert isinstance(viewer.view, Orbit)
        assert viewer.view.distance == pytest.approx(6.0, rel=1e-3)
        again = Page(browser, viewer.url, 1100, 700, resolution=COARSE)
        with contextlib.closing(again) as page:
            page.wait_for(lambda: any(viewer.state.selected.values()), "the selection", 40.0)
            assert page.errors == []
