"""A finger that rests tells what a mouse tells by resting."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
from pages import bounds
from playwright.sync_api import Locator, expect

from tests.page.page_bench import PageBench
from tests.page.tabs import ViewerTab
from webviz.tools.goal_pose import GoalPose

WIDTH, HEIGHT = 390, 844
HELD_MS = 900


@pytest.fixture(scope="module")
def lasting_phone(open_lasting_viewer_tab: Callable[..., ViewerTab]) -> ViewerTab:
    return open_lasting_viewer_tab(WIDTH, HEIGHT, has_touch=True, is_mobile=True)


@pytest.fixture
def phone(lasting_phone: ViewerTab, viewer_tab: ViewerTab) -> ViewerTab:
    """A phone with the panels closed."""
    lasting_phone.page.keyboard.press("Escape")
    lasting_phone.button("Hide the panels").evaluate_all(
        "found => found.forEach((one) => one.click())"
    )
    return lasting_phone


@pytest.fixture
def touch(phone: ViewerTab) -> Iterator[Callable[..., None]]:
    """Put a finger down at a place, or lift it."""
    session = phone.page.context.new_cdp_session(phone.page)

    def act(kind: str, *points: tuple[float, float]) -> None:
        where = [{"x": x, "y": y} for x, y in points]
        session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": where})

    yield act
    session.detach()


def test_a_finger_on_a_tool_reads_what_it_does_and_does_not_choose_it(
    phone: ViewerTab, viewer: PageBench, touch: Callable[..., None]
) -> None:
    viewer.show(tools=[GoalPose(name="Goal")])
    tool = phone.page.locator('.wv-tool[aria-label="Goal"]')
    expect(tool).to_be_visible()
    box = bounds(tool)
    tip = phone.page.get_by_role("tooltip")
    touch("touchStart", (box["x"] + 10.0, box["y"] + 10.0))
    phone.page.wait_for_timeout(HELD_MS)
    expect(tip).to_be_visible()
    touch("touchEnd")
    expect(tip).to_be_visible()
    expect(tool).to_have_attribute("aria-pressed", "false")
    touch("touchStart", (WIDTH / 2, HEIGHT / 2))
    touch("touchEnd")
    expect(tip).to_be_hidden()


def test_a_finger_on_the_scene_reads_where_it_is_until_the_next_one(
    phone: ViewerTab, touch: Callable[..., None]
) -> None:
    text = phone.page.locator(".wv-pointer")
    expect(text).to_be_hidden()
    touch("touchStart", (WIDTH / 2, 0.6 * HEIGHT))
    phone.page.wait_for_timeout(HELD_MS)
    touch("touchEnd")
    expect(text).to_be_visible()
    expect(text).to_contain_text(" m")
    touch("touchStart", (WIDTH / 2, 0.6 * HEIGHT))
    expect(text).to_be_hidden()
    touch("touchEnd")


def test_a_finger_that_moves_does_not_rest(phone: ViewerTab, touch: Callable[..., None]) -> None:
    x, y = WIDTH / 2, 0.6 * HEIGHT
    touch("touchStart", (x, y))
    for step in range(4):
        touch("touchMove", (x + 10.0 * step, y))
    phone.page.wait_for_timeout(HELD_MS)
    expect(phone.page.locator(".wv-pointer")).to_be_hidden()
    phone.page.wait_for_timeout(500)  # fingers rest before they leave, or the view goes on turning
    touch("touchEnd")


def test_menus_and_dialogs_of_a_phone_are_sheets_at_its_bottom(phone: ViewerTab) -> None:
    phone.page.get_by_role("button", name="More").first.click()
    menu = phone.page.get_by_role("menu")
    expect(menu).to_be_visible()
    assert menu.bounding_box() == _at_the_bottom(menu)
    phone.page.touchscreen.tap(WIDTH / 2, 150)
    expect(menu).to_have_count(0)
    phone.button("Show the panels").click()
    phone.button("Add display").click()
    dialog = phone.page.get_by_role("dialog", name="Add display")
    expect(dialog).to_be_visible()
    # It grows when the types of displays come.
    phone.wait_for(lambda: dialog.bounding_box() == _at_the_bottom(dialog))
    phone.page.keyboard.press("Escape")


def _at_the_bottom(sheet: Locator) -> dict[str, float]:
    box = bounds(sheet)
    height = box["height"]
    return {"x": 0.0, "y": HEIGHT - height, "width": WIDTH, "height": height}
