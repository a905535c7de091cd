"""The page on a phone, which is touched and has little space."""

from __future__ import annotations

from collections.abc import Callable

import playwright.sync_api as playwright
import pytest

from tests.page.conftest import Tab
from webviz.commands import Save
from webviz.data.messages import LaserScan, to_tree
from webviz.data.transforms import Diagnosis, FrameReport
from webviz.engine.state import ConfigFile, Inspected, Row
from webviz.sources import Offer, Publisher

WIDTH, HEIGHT = 390, 844
FINGER_PX = 40
HIT = """(element) => {
  const { left, right, top, bottom } = element.getBoundingClientRect();
  const [x, y] = [(left + right) / 2, (top + bottom) / 2];
  const reach = [...Array(61).keys()].map((i) => i - 30);
  const isHit = (x, y) => element.contains(document.elementFromPoint(x, y));
  return [reach.filter((d) => isHit(x + d, y)).length, reach.filter((d) => isHit(x, y + d)).length];
}"""
"""Width and height of an element for a finger."""


@pytest.fixture(scope="module")
def opened(open_lasting_tab: Callable[..., Tab]) -> Tab:
    return open_lasting_tab(WIDTH, HEIGHT, has_touch=True, is_mobile=True)


@pytest.fixture
def phone(opened: Tab, tab: Tab) -> Tab:
    """A phone with the panels closed."""
    opened.page.set_viewport_size({"width": WIDTH, "height": HEIGHT})
    opened.page.keyboard.press("Escape")
    hide = opened.button("Hide the panels")
    if hide.is_visible():
        hide.tap()
    return opened


def side(phone: Tab) -> playwright.Locator:
    return phone.page.get_by_role("complementary", name="Panels")


def test_the_scene_is_free_until_the_side_is_opened_over_it(
    phone: Tab, make_row: Callable[..., Row]
) -> None:
    phone.loop.show(make_row("a"), file=ConfigFile("/home/me/lab.yaml"))
    playwright.expect(side(phone)).to_be_hidden()
    assert phone.page.locator(".mantine-Paper-root:visible").count() == 0
    canvas = phone.page.locator("#root canvas").first.bounding_box()
    phone.button("Show the panels").tap()
    phone.wait_for(lambda: "lab.yaml" in side(phone).inner_text())
    sheet = side(phone).bounding_box()
    assert sheet is not None
    assert (sheet["x"], sheet["width"]) == (0, WIDTH)
    assert 0.25 * HEIGHT < sheet["y"] < 0.45 * HEIGHT
    assert phone.page.locator("#root canvas").first.bounding_box() == canvas
    phone.page.touchscreen.tap(200, 200)  # beside it
    playwright.expect(side(phone)).to_be_hidden()


def test_buttons_can_be_hit_with_a_finger(phone: Tab) -> None:
    phone.loop.show(file=ConfigFile("/home/me/lab.yaml"))
    phone.button("Show the panels").tap()
    for name in ("Menu", "Commands", "Hide the panels", "Show the panels"):
        box = phone.button(name).bounding_box()
        assert box is not None
        assert box["height"] >= FINGER_PX, name
        assert box["width"] >= FINGER_PX, name
        assert box["x"] >= 0, name
        assert box["x"] + box["width"] <= WIDTH, name
    phone.button("Menu").tap()
    item = phone.page.get_by_role("menuitem", name="Save Ctrl+S")
    box = item.bounding_box()
    assert box is not None
    assert box["height"] >= FINGER_PX
    item.tap()
    phone.wait_for_command(Save())


def test_rows_and_heads_of_panels_can_be_hit_with_a_finger(phone: Tab) -> None:
    scan = Publisher("/driver", "sensor_msgs/msg/LaserScan", "reliable", "volatile")
    message = to_tree(LaserScan())
    odom = FrameReport("odom", "map", True, (), 0.0, 0, None, None, 1, 0, ())
    phone.loop.show(
        offers={"/scan": Offer((scan,))},
        inspected={"/scan": Inspected(scan.type, message, "", 100, 1.0)},
        transforms=Diagnosis(("map",), (), (odom,)),
    )
    phone.button("Show the panels").tap()
    phone.show_tab("Topics")
    phone.wait_for(lambda: phone.page.locator(".wv-topic").count() == 1)
    phone.page.locator(".wv-topic").tap()
    phone.wait_for(lambda: phone.page.locator(".wv-field-row").count() > 3)
    assert too_small(phone) == []
    phone.show_tab("TF")
    phone.wait_for(lambda: phone.page.locator(".wv-frame").count() == 2)
    assert too_small(phone) == []
    assert min(phone.page.locator(".wv-fold-mark").first.evaluate(HIT)) >= FINGER_PX - 1
    phone.show_tab("Displays")
    assert min(phone.page.locator(".wv-tree-fold").first.evaluate(HIT)) >= FINGER_PX - 1


def test_of_more_tabs_than_fit_the_open_one_is_in_sight(phone: Tab) -> None:
    phone.page.set_viewport_size({"width": 250, "height": HEIGHT})
    phone.button("Show the panels").tap()
    tab = phone.page.get_by_role("tab").last
    first = phone.page.get_by_role("tab").first
    first.focus()
    phone.page.keyboard.press("ArrowLeft")
    playwright.expect(tab).to_be_in_viewport(ratio=0.95)
    assert phone.page.evaluate("document.documentElement.scrollWidth") == 250
    phone.page.keyboard.press("ArrowRight")
    playwright.expect(first).to_be_in_viewport(ratio=0.95)
    first.hover()
    phone.page.mouse.wheel(0, 300)
    playwright.expect(tab).to_be_in_viewport(ratio=0.95)
    phone.button("All panels").tap()
    phone.page.get_by_role("menuitemradio", name="Displays").tap()
    playwright.expect(first).to_be_in_viewport(ratio=0.95)
    assert first.get_attribute("aria-selected") == "true"
    phone.page.set_viewport_size({"width": WIDTH, "height": HEIGHT})
    playwright.expect(phone.button("All panels")).to_be_hidden()


def too_small(phone: Tab) -> list[str]:
    """Return the elements of the panel that can be tapped but are too low."""
    return phone.page.locator(".wv-panel").evaluate(
        """(panel, least) => [...panel.querySelectorAll("button, input, select, .wv-row")]
          .filter((one) => one.checkVisibility() && one.getBoundingClientRect().height < least)
          .map((one) => `${one.className} ${one.getBoundingClientRect().height}`)""",
        FINGER_PX,
    )


def test_dialogs_fit(phone: Tab) -> None:
    phone.loop.show(file=ConfigFile(folder="/home/me/a folder/" + "with_a_long_name" * 10))
    phone.button("Show the panels").tap()
    phone.wait_for(lambda: "webviz" in side(phone).inner_text())
    phone.button("Menu").tap()
    phone.page.get_by_role("menuitem", name="Save as…").tap()
    box = phone.page.get_by_role("dialog").bounding_box()
    assert box is not None
    assert box["x"] >= 0
    assert box["x"] + box["width"] <= WIDTH
    assert phone.page.evaluate("document.documentElement.scrollWidth") == WIDTH
