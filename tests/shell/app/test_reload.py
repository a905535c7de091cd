"""A page that is loaded again (F5): its camera and its panels stay, others begin anew."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec
import playwright.sync_api as playwright
import pytest

import webviz
from webviz.api.views import FPS, Orbit, ThirdPersonFollower, TopDownOrtho, View, XYOrbit
from webviz.shell.pictures.browser import Page
from webviz.shell.testing.source import HandFedSource

VIEWS = [
    Orbit(distance=6.0, yaw=-2.0, pitch=0.4, focal_point=(1.0, 2.0, -0.5), target_frame="base"),
    XYOrbit(distance=6.0, yaw=0.4, pitch=0.9, invert_z_axis=True),
    ThirdPersonFollower(distance=6.0, yaw=3.0, pitch=0.2, focal_point=(1.0, 2.0, 0.0)),
    FPS(yaw=2.5, pitch=-0.3, position=(1.0, -2.0, 1.5)),
    TopDownOrtho(scale=37.5, angle=2.0, x=-3.0, y=1.25),
]
SHOW = "async (view) => (await import('webviz/act.js')).act('ShowView', { view })"
ADD = "async (type) => (await import('webviz/act.js')).act('AddPanel', { type, values: {} })"


@pytest.fixture(scope="module")
def viewer() -> Iterator[webviz.Viewer]:
    with webviz.Viewer(port=0, source=HandFedSource()) as viewer:
        viewer.config = {"displays": []}
        yield viewer


@pytest.fixture(scope="module")
def page(browser: playwright.Browser, viewer: webviz.Viewer) -> Iterator[Page]:
    page = Page(browser, viewer.url, 900, 600)
    yield page
    assert page.errors == []
    page.close()


def view_of(page: Page, viewer: webviz.Viewer) -> View | None:
    views: dict[int, View] = viewer.fact("views")
    return views.get(page.evaluate("() => window.webviz.browser"))


def are_near(a: View | None, b: View) -> bool:
    if type(a) is not type(b):
        return False
    one, other = (msgspec.to_builtins(each) for each in (a, b))
    numbers = [(one[key], other[key]) for key in one if not isinstance(one[key], str | bool)]
    same = {key: one[key] == other[key] for key in one if isinstance(one[key], str | bool)}
    return all(same.values()) and all(x == pytest.approx(y, abs=1e-4) for x, y in numbers)


def load_again(page: Page) -> None:
    page.tab.reload()
    page.tab.wait_for_function("window.webviz?.hasView() && window.webviz.browser !== null")


@pytest.mark.parametrize("view", VIEWS, ids=lambda view: type(view).__name__)
def test_the_camera_stays_where_it_was(page: Page, viewer: webviz.Viewer, view: View) -> None:
    page.evaluate(SHOW, msgspec.to_builtins(view))
    page.wait_for(lambda: are_near(view_of(page, viewer), view), "the view")
    load_again(page)
    page.wait_for(lambda: are_near(view_of(page, viewer), view), "the same view")


def test_a_camera_that_was_moved_by_hand_stays(page: Page, viewer: webviz.Viewer) -> None:
    page.evaluate(SHOW, msgspec.to_builtins(Orbit()))
    page.wait_for(lambda: are_near(view_of(page, viewer), Orbit()), "the view")
    page.tab.mouse.move(650, 300)
    page.tab.mouse.down()
    page.tab.mouse.move(750, 340, steps=5)
    page.tab.mouse.up()
    page.wait_for(lambda: not are_near(view_of(page, viewer), Orbit()), "the view has turned")
    page.tab.wait_for_timeout(500.0)  # viser's camera comes to rest
    new_view = view_of(page, viewer)
    assert new_view is not None
    load_again(page)
    page.wait_for(lambda: are_near(view_of(page, viewer), new_view), "the same view")


def test_another_page_begins_with_the_view_of_the_config(
    browser: playwright.Browser, page: Page, viewer: webviz.Viewer
) -> None:
    page.evaluate(SHOW, msgspec.to_builtins(VIEWS[1]))
    page.wait_for(lambda: are_near(view_of(page, viewer), VIEWS[1]), "the view")
    other = Page(browser, viewer.url, 900, 600)
    other.wait_for(lambda: view_of(other, viewer), "the report of the page")
    assert are_near(view_of(other, viewer), viewer.view)
    other.close()


def test_the_panel_in_front_stays_in_front(page: Page) -> None:
    docked = page.tab.locator(".wv-docked")
    for type_ in ("Log", "Plot"):
        page.evaluate(ADD, type_)
        page.wait_for(docked.is_visible, type_)
    tabs = docked.get_by_role("tab")
    page.wait_for(lambda: tabs.count() == 2, "two tabs")
    for name in ("Log", "Plot"):
        tabs.filter(has_text=name).click()
        playwright.expect(docked).to_have_attribute("aria-label", name)
        load_again(page)
        playwright.expect(docked).to_have_attribute("aria-label", name)
