"""Panes of images: which are there, and their size, zoom and place."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest
from pages import bounds

from tests.page.image_panes import (
    COLORS,
    id_of,
    image,
    images_in,
    middle,
    near,
    pane,
    pane_color,
)
from tests.page.page_bench import PageBench, PageServer
from tests.page.tabs import ViewerTab
from webviz.commands import AddDisplay, RemoveDisplay, SetLayout
from webviz.files.config import DockedPanel, Layout
from webviz.server.channel.messages import MAX_PANES


@pytest.fixture
def tab(viewer: PageBench, viewer_tab: ViewerTab) -> Iterator[ViewerTab]:
    """The tab with two images."""
    with images_in(viewer, viewer_tab) as tab:
        yield tab


def test_a_pane_says_what_its_display_misses_and_goes_with_it(tab: ViewerTab) -> None:
    viewer = tab.viewer
    viewer.do(AddDisplay("Image", {"topic": "/gone"}))
    tab.wait_for(lambda: "No publisher on /gone" in pane(tab, "Gone").inner_text())
    viewer.do(RemoveDisplay(id_of(viewer, "Gone")))
    tab.wait_for(lambda: pane(tab, "Gone").count() == 0)


def test_a_page_asks_for_as_many_pictures_as_the_server_allows(
    tab: ViewerTab, page_server: PageServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz.server.images.pictures.UNSEEN_S", 0.0)
    viewer = tab.viewer
    viewer.show(*(image(f"/camera{number}") for number in range(MAX_PANES + 6)))
    ids = [row.id for row in viewer.rows]

    def visible_ids() -> set[str]:
        return {id_ for id_ in ids if not page_server.scene.is_unseen(id_)}

    tab.wait_for(lambda: visible_ids() == set(ids[:MAX_PANES]))
    for id_ in ids[:10]:
        viewer.do(RemoveDisplay(id_))
    tab.wait_for(lambda: visible_ids() >= set(ids[10:]))


def test_two_images_of_one_topic_have_their_names_too(tab: ViewerTab) -> None:
    tab.viewer.show(image("/front", "Left"), image("/front", "Right"), image("/rear"))
    titles = ["/front (Left)", "/front (Right)", "/rear"]
    tab.wait_for(lambda: tab.page.locator(".wv-pane-head b").all_inner_texts() == titles)


def width(tab: ViewerTab) -> float:
    """Return the width of the picture "Color" on the screen, in pixels."""
    canvas = pane(tab, "Color").locator("canvas")
    canvas.wait_for()
    return bounds(canvas)["width"]


def pixel_at(tab: ViewerTab, x: float, y: float) -> list[float]:
    """Column and row of the picture "Color" at a place of the window."""
    value = pane(tab, "Color").locator(".wv-pane-value")
    tab.page.mouse.move(0, 0)
    value.wait_for(state="hidden")
    tab.page.mouse.move(x, y)
    tab.wait_for(lambda: re.match(r"x \d+ . y \d+", value.inner_text()))
    words = value.inner_text().split()
    return [float(words[1]), float(words[4])]


def test_a_picture_is_zoomed_at_the_mouse_and_moved_and_the_page_is_not_zoomed(
    tab: ViewerTab,
) -> None:
    whole, (x, y) = width(tab), middle(tab)
    there = pixel_at(tab, x + 30, y + 20)
    tab.page.mouse.wheel(0, -1000)
    tab.wait_for(lambda: width(tab) == pytest.approx(4 * whole))
    assert pixel_at(tab, x + 30, y + 20) == pytest.approx(there, abs=1)
    tab.page.mouse.down()
    tab.page.mouse.move(x, y, steps=3)
    tab.page.mouse.up()
    assert pixel_at(tab, x, y) == pytest.approx(there, abs=1)
    tab.page.keyboard.down("Control")
    tab.page.mouse.wheel(0, -100)
    tab.page.keyboard.up("Control")
    tab.wait_for(lambda: width(tab) == pytest.approx(8 * whole))
    assert tab.page.evaluate("[devicePixelRatio, visualViewport.scale]") == [1, 1]
    tab.page.mouse.dblclick(x, y)
    tab.wait_for(lambda: width(tab) == pytest.approx(whole))


def test_a_picture_is_zoomed_by_keys_and_by_two_fingers(tab: ViewerTab) -> None:
    whole, (x, y) = width(tab), middle(tab)
    there = pixel_at(tab, x, y)
    pane(tab, "Color").locator("canvas").focus()
    tab.page.keyboard.press("+")
    tab.wait_for(lambda: width(tab) == pytest.approx(1.5 * whole))
    tab.page.keyboard.press("ArrowRight")
    tab.wait_for(lambda: pixel_at(tab, x, y)[0] > there[0])
    tab.page.keyboard.press("0")
    tab.wait_for(lambda: width(tab) == pytest.approx(whole))
    touch = tab.page.context.new_cdp_session(tab.page)
    touch.send("Emulation.setTouchEmulationEnabled", {"enabled": True, "maxTouchPoints": 2})

    def put(event: str, *apart: float) -> None:
        points = [{"x": x + each, "y": y, "id": id_} for id_, each in enumerate(apart)]
        touch.send("Input.dispatchTouchEvent", {"type": event, "touchPoints": points})

    put("touchStart", -20, 20)
    for apart in (30, 40, 50, 60):
        put("touchMove", -apart, apart)
    put("touchEnd")
    touch.send("Emulation.setTouchEmulationEnabled", {"enabled": False})
    tab.wait_for(lambda: width(tab) == pytest.approx(3 * whole))
    assert tab.page.evaluate("visualViewport.scale") == 1
    button = tab.button("Reset the zoom of /color")
    assert "3.0" in button.inner_text()
    button.click()
    tab.wait_for(lambda: width(tab) == pytest.approx(whole))


def test_an_image_is_as_high_as_its_picture_and_is_placed_as_a_panel(tab: ViewerTab) -> None:
    body = pane(tab, "Color").locator(".wv-pane-body")
    tab.wait_for(lambda: abs((box := bounds(body))["width"] / box["height"] - 4 / 3) < 0.02)
    room = bounds(tab.page.locator("#root"))
    tab.page.mouse.move(*(bounds(pane(tab, "Color").locator("b"))[k] + 5 for k in "xy"))
    tab.page.mouse.down()
    tab.page.mouse.move(room["x"] + 100, room["y"] + room["height"] - 10, steps=4)
    tab.page.mouse.up()
    below = DockedPanel(panel="image:Image")
    tab.wait_for_command(SetLayout(Layout(below=(below,))))
    assert tab.viewer.settings.layout == Layout(below=(below,))
    frame = tab.page.locator(".wv-below .wv-docked")
    tab.wait_for(lambda: "Hz" in frame.locator(".wv-docked-head").inner_text())
    assert frame.locator(".wv-docked-head b").inner_text() == "/color"
    assert near(pane_color(tab, "Color"), COLORS[108, 80])
    assert tab.page.locator(".wv-panes .wv-pane").count() == 1
    # Of two in one place, the one behind gets its pictures when it is chosen.
    both = Layout(below=(DockedPanel(panel="image:Image", tabs=("image:Image 2",)),))
    tab.viewer.do(SetLayout(both))
    tab.wait_for(lambda: frame.get_by_role("tab").all_inner_texts() == ["/color", "/depth"])
    frame.get_by_role("tab", name="/depth").click()
    tab.wait_for(lambda: near(pane_color(tab, "Depth", (0.02, 0.02)), (0, 0, 0)))
    assert tab.page.locator(".wv-dock").is_hidden()
    frame.get_by_role("button", name="With the images").click()
    tab.wait_for_command(SetLayout(Layout(below=(below,))))
    tab.viewer.do(SetLayout(Layout()))
    tab.wait_for(lambda: tab.page.locator(".wv-panes .wv-pane").count() == 2)
    assert pane(tab, "Depth").locator(".wv-pane-head").inner_text().startswith("/depth")


def test_images_and_scene_have_the_same_share_of_a_narrow_window(tab: ViewerTab) -> None:
    size = tab.page.viewport_size
    assert size is not None
    tab.page.evaluate("localStorage.clear()")
    tab.page.get_by_label("Size of the images").dblclick(position={"x": 2, "y": 300})
    root, dock = tab.page.locator("#root"), tab.page.get_by_label("Images", exact=True)
    for width, side in ((900, "width"), (700, "height")):  # beside each other, one below the other
        tab.page.set_viewport_size({"width": width, "height": 600})
        other = "height" if side == "width" else "width"

        def are_fair(side: str = side, other: str = other) -> bool:
            scene, images = bounds(root), bounds(dock)
            like = abs(scene[other] - images[other]) < 2
            return like and abs(scene[side] - images[side]) < 50  # of the bar below

        tab.wait_for(are_fair)
    tab.page.set_viewport_size(size)


def test_panes_fill_the_window_and_leave_it(tab: ViewerTab) -> None:
    canvas = pane(tab, "Color").locator("canvas")
    before = bounds(canvas)["width"]
    canvas.dblclick()
    tab.wait_for(lambda: bounds(canvas)["width"] > 800)
    tab.page.keyboard.press("Escape")
    tab.wait_for(lambda: bounds(canvas)["width"] == before)
    button = pane(tab, "Color").get_by_role("button", name="Full size of /color")
    button.click()
    tab.wait_for(lambda: bounds(canvas)["width"] > 800)
    button.click()
    tab.wait_for(lambda: bounds(canvas)["width"] == before)
    border = tab.page.get_by_label("Size of the images")
    border.focus()
    tab.page.keyboard.press("ArrowLeft")
    tab.wait_for(lambda: bounds(canvas)["width"] > before)
    tab.page.keyboard.press("ArrowRight")
    root = tab.page.locator("#root")

    def is_beside() -> bool:
        scene, box = bounds(root), bounds(canvas)
        return scene["width"] > 100 and scene["x"] + scene["width"] <= box["x"]

    tab.wait_for(is_beside)


def test_on_a_phone_images_are_below_the_scene(tab: ViewerTab) -> None:
    size = tab.page.viewport_size
    assert size is not None
    tab.page.set_viewport_size({"width": 400, "height": 800})
    root, canvas = tab.page.locator("#root"), pane(tab, "Color").locator("canvas")

    def is_below() -> bool:
        scene, box = bounds(root), bounds(canvas)
        return scene["width"] == 400 and box["y"] >= scene["y"] + scene["height"] > 100

    tab.wait_for(is_below)
    tab.button("Show the panels").click()
    tab.page.get_by_role("button", name="Add display").click(trial=True)  # nothing is above it
    tab.button("Hide the panels").click()
    tab.page.set_viewport_size(size)
    tab.wait_for(lambda: bounds(root)["width"] < size["width"] - 600)
