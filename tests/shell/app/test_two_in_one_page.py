"""Two viewers in one document, each in a frame, as a dashboard or a notebook has them."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape
from pathlib import Path

import playwright.sync_api as playwright
import pytest
from serving import served_folder

import webviz
from webviz.api.roles import Role
from webviz.commands import AddDisplay
from webviz.files.opening import parse
from webviz.server.access.starting import link
from webviz.server.access.tokens import role_of
from webviz.shell.testing.source import HandFedSource

CONFIGS = (
    "displays: [{type: Grid, name: Floor}, {type: Axes, name: Origin}]",
    "displays: [{type: Grid, name: Floor}, {type: Axes, name: Base}]",
)
ROLES = (Role.WATCHER, Role.OWNER)
STYLE = "width: 900px; height: 420px; border: 0; display: block"
PLACE = """async () => {
  const { camera } = await import("webviz/viser_page.js");
  return camera().position.toArray().map((each) => each.toFixed(3)).join(" ");
}"""
ROLE = """async () => (await import("webviz/access.js")).self().role"""
IS_LOST = "document.body.classList.contains('wv-lost')"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Path, str]]:
    """A folder of pages that are served, and their origin."""
    path = tmp_path_factory.mktemp("site")
    with served_folder(path) as port:
        yield path, f"http://localhost:{port}"


@pytest.fixture(scope="module")
def viewers(folder: tuple[Path, str]) -> Iterator[list[webviz.Viewer]]:
    def make_viewer(text: str) -> webviz.Viewer:
        return webviz.Viewer(
            port=0,
            source=HandFedSource(),
            read=lambda *_: parse(text, "x.yaml"),
            embed_in=(folder[1],),
            token=True,
        )

    with make_viewer(CONFIGS[0]) as first, make_viewer(CONFIGS[1]) as second:
        yield [first, second]


def address(viewer: webviz.Viewer, role: Role) -> str:
    """Return the link of a role, at the site of the document: browsers keep cookies of no other."""
    (token,) = (each for each in viewer.access.tokens if role_of(each) is role)
    return f"{link(viewer.url.replace('127.0.0.1', 'localhost'), token)}&fixedDpr=0.1"


@pytest.fixture(scope="module")
def frames(
    folder: tuple[Path, str], viewers: list[webviz.Viewer], browser: playwright.Browser
) -> Iterator[list[playwright.Frame]]:
    path, origin = folder
    links = [address(viewer, role) for viewer, role in zip(viewers, ROLES, strict=True)]
    (path / "both.html").write_text(
        "".join(f'<iframe src="{escape(each)}" style="{STYLE}"></iframe>' for each in links)
    )
    page = browser.new_page(viewport={"width": 900, "height": 860})
    page.goto(f"{origin}/both.html")
    elements = [each.content_frame() for each in page.query_selector_all("iframe")]
    yield [ready(each) for each in elements if each]
    page.close()


def ready(frame: playwright.Frame) -> playwright.Frame:
    frame.wait_for_function("window.webviz?.hasView()", timeout=60_000)
    return frame


def load_again(frame: playwright.Frame) -> None:
    with frame.page.expect_event("framenavigated", lambda each: each == frame):
        frame.evaluate("location.reload()")
    ready(frame)


def names(frame: playwright.Frame) -> list[str]:
    rows = frame.locator(".wv-tree-node:not([data-id=global]) .wv-tree-name")
    rows.first.wait_for()
    return rows.all_text_contents()


def selected(frame: playwright.Frame) -> list[str]:
    rows = frame.locator("[role=treeitem][aria-selected=true] .wv-tree-name")
    return rows.all_text_contents()


def stored(frame: playwright.Frame) -> dict[str, str]:
    return dict(frame.evaluate("({ ...localStorage, ...sessionStorage })"))


def test_each_has_its_own_connection_role_and_displays(
    viewers: list[webviz.Viewer], frames: list[playwright.Frame]
) -> None:
    assert [frame.evaluate(ROLE) for frame in frames] == [role.name.lower() for role in ROLES]
    assert [names(frame) for frame in frames] == [["Floor", "Origin"], ["Floor", "Base"]]


def test_each_has_its_own_view(frames: list[playwright.Frame]) -> None:
    for turning, still in (frames, frames[::-1]):
        before = turning.evaluate(PLACE), still.evaluate(PLACE)
        canvas = turning.locator("canvas").first
        box = canvas.bounding_box()
        assert box
        mouse = turning.page.mouse
        mouse.move(box["x"] + 0.6 * box["width"], box["y"] + 0.6 * box["height"])
        mouse.down()
        mouse.move(box["x"] + 0.7 * box["width"], box["y"] + 0.65 * box["height"], steps=4)
        mouse.up()
        turning.wait_for_function(f"async (before) => await ({PLACE})() !== before", arg=before[0])
        assert still.evaluate(PLACE) == before[1]


def test_each_has_its_own_selection_theme_and_panel_also_after_one_is_loaded_again(
    frames: list[playwright.Frame],
) -> None:
    first, second = frames
    for frame, name in zip(frames, ("Origin", "Floor"), strict=True):
        frame.locator(".wv-tree-name", has_text=name).click()
    assert [selected(frame) for frame in frames] == [["Origin"], ["Floor"]]
    before = stored(first)
    second.evaluate("async () => (await import('webviz/shell/theme.js')).setTheme('dark')")
    second.get_by_role("tab", name="Views").click()
    second.wait_for_function("localStorage.getItem('webviz.tab') === '\"views\"'")
    place = second.evaluate(PLACE)
    load_again(second)
    second.get_by_role("tab", name="Views", selected=True).wait_for()
    second.wait_for_function(f"async (place) => await ({PLACE})() === place", arg=place)
    assert second.evaluate("document.documentElement.dataset.wvTheme") == "dark"
    assert second.evaluate(ROLE) == "owner"

    assert stored(first) == before
    load_again(first)
    first.get_by_role("tab", name="Displays", selected=True).wait_for()
    first.locator("[role=treeitem][aria-selected=true]", has_text="Origin").wait_for()
    assert first.evaluate("document.documentElement.dataset.wvTheme") == "light"
    assert first.evaluate(ROLE) == "watcher"


def test_one_goes_on_when_the_viewer_of_the_other_ends(
    viewers: list[webviz.Viewer], frames: list[playwright.Frame]
) -> None:
    first, second = frames
    viewers[0].close()
    first.wait_for_function(IS_LOST)
    viewers[1].do(AddDisplay("Axes", values={"name": "Tool"}))
    second.get_by_role("tab", name="Displays").click()
    second.get_by_role("treeitem", name="Tool", exact=True).wait_for()
    assert not second.evaluate(IS_LOST)
