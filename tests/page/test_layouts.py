"""Panels beside, below and over the scene: dragged with a mouse, whole, and in windows."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from urllib.parse import quote

import playwright.sync_api as playwright
import pytest
from pages import bounds
from playwright.sync_api import expect

from tests.page.page_bench import PageBench, PageServer
from tests.page.tabs import ViewerTab
from webviz.commands import (
    AddPanel,
    RemoveLayout,
    RemovePanel,
    SaveLayout,
    SetLayout,
    UseTemplate,
)
from webviz.engine.parts.panels import PanelsPart
from webviz.features.layouts import layout_store
from webviz.files.config import DockedPanel, FloatingPanel, Layout

HOSTILE = "<img src=x onerror=alert(1)>"
BESIDE = Layout(beside=(DockedPanel(panel="doctor"),))


@pytest.fixture
def tab(viewer_tab: ViewerTab) -> ViewerTab:
    return viewer_tab


@pytest.fixture(autouse=True)
def _close(page_server: PageServer, tab: ViewerTab) -> Iterator[None]:
    yield
    tab.page.keyboard.press("Escape")
    viewer = page_server.begin()
    viewer.show(layout=BESIDE)
    tab.wait_for(lambda: docked(tab) == {"doctor": "wv-beside"})
    viewer.show()
    tab.wait_for(lambda: docked(tab) == {})


def docked(tab: ViewerTab) -> dict[str, str]:
    """The place of each panel that is not in the tabs."""
    return tab.page.evaluate(
        "Object.fromEntries([...document.querySelectorAll('.wv-docked')]"
        ".map(e => [e.dataset.panel, e.parentElement.className]))"
    )


def middle(element: playwright.Locator) -> tuple[float, float]:
    box = bounds(element)
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def drag(tab: ViewerTab, element: playwright.Locator, x: float, y: float) -> None:
    mouse = tab.page.mouse
    mouse.move(*middle(element))
    mouse.down()
    mouse.move(x, y, steps=4)
    mouse.up()


def scene(tab: ViewerTab) -> dict[str, float]:
    box = bounds(tab.page.locator("#root"))
    return {key: float(value) for key, value in box.items() if isinstance(value, int | float)}


def newest(viewer: PageBench) -> Layout:
    """The arrangement that the page has asked for last."""
    command = viewer.commands[-1]
    assert isinstance(command, SetLayout)
    assert isinstance(command.layout, Layout)
    return command.layout


def test_a_tab_is_dragged_to_each_place_and_back(viewer: PageBench, tab: ViewerTab) -> None:
    topics = tab.page.locator("#wv-tab-topics")
    room = scene(tab)
    drag(tab, topics, room["x"] + room["width"] - 20, room["y"] + room["height"] / 2)
    tab.wait_for_command(SetLayout(Layout(beside=(DockedPanel(panel="topics"),))))
    assert docked(tab) == {"topics": "wv-beside"}
    assert topics.count() == 0
    tab.wait_for(lambda: scene(tab)["width"] <= room["width"] - 300)

    head = tab.page.locator(".wv-docked-head")
    drag(tab, head, room["x"] + 200, room["y"] + room["height"] - 20)
    tab.wait_for(lambda: docked(tab) == {"topics": "wv-below"})
    tab.wait_for(lambda: scene(tab)["height"] <= room["height"] - 200)

    drag(tab, head, room["x"] + 300, room["y"] + 200)
    tab.wait_for(lambda: docked(tab) == {"topics": "wv-floats"})
    tab.wait_for(lambda: scene(tab) == room)
    tab.wait_for(lambda: newest(viewer).over != ())
    (over,) = newest(viewer).over
    assert over.panel == "topics"
    assert 0 < over.left < 0.3
    assert 0 < over.top < 0.4

    drag(tab, head, 100, 400)
    tab.wait_for_command(SetLayout(Layout()))
    assert docked(tab) == {}
    assert topics.is_visible()


def test_an_arrangement_of_others_is_shown_and_sizes_can_be_changed(
    viewer: PageBench, tab: ViewerTab
) -> None:
    arranged = Layout(
        beside=(DockedPanel(panel="doctor"), DockedPanel(panel="views", weight=3)),
        over=(FloatingPanel(panel=HOSTILE), FloatingPanel(panel="topics", left=0.1)),
        width=300,
    )
    viewer.show(layout=arranged)
    tab.wait_for(lambda: len(docked(tab)) == 3)
    heights = tab.page.locator(".wv-beside .wv-docked").evaluate_all(
        "each => each.map(e => e.offsetHeight)"
    )
    assert 2.5 < heights[1] / heights[0] < 3.5

    border = tab.page.get_by_role("separator", name="Width of the panels beside the scene")
    border.focus()
    tab.page.keyboard.press("ArrowLeft")
    tab.wait_for(lambda: bool(viewer.commands))
    wider = newest(viewer)
    assert wider.width == 316
    corner = tab.page.locator("[data-panel=topics] .wv-docked-corner")
    x, y = middle(corner)
    drag(tab, corner, x + 60, y + 40)
    tab.wait_for(lambda: newest(viewer) is not wider)
    assert newest(viewer).over[1].width > arranged.over[1].width


def test_a_refused_arrangement_is_taken_back(viewer: PageBench, tab: ViewerTab) -> None:
    viewer.viewer.close()
    drag(tab, tab.page.locator("#wv-tab-topics"), 700, 300)
    tab.wait_for(lambda: bool(viewer.commands))
    tab.wait_for(lambda: docked(tab) == {})
    assert "The viewer has ended." in tab.text()


def test_escape_leaves_full_screen_and_cancels_a_drag(viewer: PageBench, tab: ViewerTab) -> None:
    viewer.show(layout=BESIDE)
    tab.wait_for(lambda: docked(tab) == {"doctor": "wv-beside"})
    frame = tab.page.locator(".wv-docked")
    # The toolbar has one, too, until it has found that there is no room for it.
    frame.get_by_role("button", name="Full screen").click()
    tab.wait_for(lambda: (frame.bounding_box() or {}).get("x") == 0)
    tab.page.keyboard.press("Escape")
    tab.wait_for(lambda: (frame.bounding_box() or {})["x"] > 500)

    tab.page.mouse.move(*middle(tab.page.locator(".wv-docked-head b")))
    tab.page.mouse.down()
    tab.page.mouse.move(500, 300, steps=4)
    tab.wait_for(lambda: "Over the scene" in tab.text())
    tab.page.keyboard.press("Escape")
    tab.page.mouse.up()
    tab.turn()
    assert not viewer.commands
    assert docked(tab) == {"doctor": "wv-beside"}


def test_panels_of_one_place_are_tabs_which_keys_and_drags_change(
    viewer: PageBench, tab: ViewerTab
) -> None:
    shared = Layout(below=(DockedPanel(panel="doctor", tabs=("views",)),))
    viewer.show(layout=shared)
    tab.wait_for(lambda: docked(tab) == {"doctor": "wv-below"})
    here = tab.page.get_by_role("tablist", name="Panels here").get_by_role("tab")
    assert here.all_inner_texts() == ["Doctor", "Views"]
    here.first.focus()
    tab.page.keyboard.press("ArrowRight")
    tab.wait_for(lambda: docked(tab) == {"views": "wv-below"})
    expect(here.last).to_be_focused()
    expect(here.last).to_have_attribute("aria-selected", "true")
    assert not viewer.commands, "it is the choice of this page"

    topics = tab.page.locator("#wv-tab-topics")
    head = tab.page.locator(".wv-docked-head")
    drag(tab, topics, *middle(head))
    three = Layout(below=(DockedPanel(panel="doctor", tabs=("views", "topics")),))
    tab.wait_for_command(SetLayout(three))
    assert viewer.settings.layout == three
    tab.wait_for(lambda: docked(tab) == {"topics": "wv-below"})

    room = scene(tab)
    drag(tab, here.first, room["x"] + room["width"] - 20, room["y"] + 100)
    apart = Layout(
        beside=(DockedPanel(panel="doctor"),), below=(DockedPanel(panel="views", tabs=("topics",)),)
    )
    tab.wait_for_command(SetLayout(apart))
    assert docked(tab) == {"doctor": "wv-beside", "topics": "wv-below"}


def test_a_wide_panel_that_is_added_comes_to_the_front_of_its_place(
    viewer: PageBench, tab: ViewerTab
) -> None:
    viewer.show(layout=Layout(below=(DockedPanel(panel="doctor"),)))
    tab.wait_for(lambda: docked(tab) == {"doctor": "wv-below"})
    tab.show_tab("Topics")
    tab.button("Add a panel").click()
    tab.page.keyboard.type("plot")
    tab.page.keyboard.press("Enter")
    tab.wait_for_command(AddPanel("Plot"))
    (plot,) = viewer.viewer.get(PanelsPart).tabs()
    below = Layout(below=(DockedPanel(panel="doctor", tabs=("Plot",)),))
    assert viewer.settings.layout == below
    tab.wait_for(lambda: docked(tab) == {"plugin-Plot": "wv-below"})
    expect(tab.page.locator("#wv-tab-topics")).to_have_attribute("aria-selected", "true")
    tab.page.locator(".wv-docked").get_by_role("button", name="Remove panel").click()
    tab.wait_for_command(RemovePanel(plot.id))
    viewer.show()
    tab.show_tab("Displays")


def test_layouts_are_saved_shown_and_removed_by_the_menu(viewer: PageBench, tab: ViewerTab) -> None:
    viewer.show(layouts={"driving": BESIDE, HOSTILE: Layout()})

    def choose(*names: str) -> None:
        tab.button("Menu").click()
        for name in ("Layout", *names):
            tab.page.get_by_role("menuitem", name=name).or_(
                tab.page.get_by_role("menuitemradio", name=name)
            ).last.click()

    choose("driving")
    tab.wait_for_command(SetLayout("driving"))
    choose("Remove", HOSTILE)
    tab.wait_for_command(RemoveLayout(HOSTILE))
    choose("Tune")
    tab.wait_for_command(UseTemplate("Tune"))
    choose("Save this layout")
    tab.page.get_by_label("Name of the layout").fill("lab")
    tab.page.keyboard.press("Enter")
    tab.wait_for_command(SaveLayout("lab"))


def test_a_window_shows_one_panel_or_a_layout(
    viewer: PageBench, tab: ViewerTab, open_viewer_tab: Callable[..., ViewerTab]
) -> None:
    viewer.show(layouts={"driving": BESIDE})
    other = open_viewer_tab(query="&panel=topics")
    other.wait_for(lambda: docked(other) == {"topics": "wv-floats"})
    other.wait_for(lambda: not other.page.locator("#root").is_visible())
    other.page.goto(other.page.url.replace("panel=topics", "layout=driving"))
    other.wait_for(lambda: docked(other) == {"doctor": "wv-beside"})
    assert docked(tab) == {}


def test_a_window_for_an_unknown_panel_says_so(open_viewer_tab: Callable[..., ViewerTab]) -> None:
    other = open_viewer_tab(query="&panel=" + quote(HOSTILE))
    expect(other.page.get_by_text(f"Unknown panel `{HOSTILE}`.")).to_be_visible()


def test_a_phone_keeps_its_collapsed_panel(viewer: PageBench, tab: ViewerTab) -> None:
    viewer.show(layout=BESIDE)
    tab.wait_for(lambda: docked(tab) == {"doctor": "wv-beside"})
    size = tab.page.viewport_size
    assert size is not None
    tab.page.set_viewport_size({"width": 390, "height": 780})
    tab.wait_for(lambda: docked(tab) == {})
    assert scene(tab)["width"] == 390
    tab.page.set_viewport_size(size)


def test_a_store_has_the_saved_layout_of_a_window(viewer: PageBench) -> None:
    viewer.show(layouts={"driving": BESIDE})
    assert [each.panel for each in layout_store(viewer.settings, "driving").beside] == ["doctor"]
    assert not layout_store(viewer.settings, "unknown").beside
