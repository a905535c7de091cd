"""The toolbar over the scene."""

from __future__ import annotations

from dataclasses import replace

import playwright.sync_api as playwright
import pytest

from tests.page.conftest import Tab
from webviz.api.views import FPS, Orbit
from webviz.commands import ChangeView, ResetView, SaveView, SetFixedFrame, ShowView, StartWithView
from webviz.engine.commands import Command
from webviz.engine.state import ToolButton
from webviz.files.config import Settings

GOAL = ToolButton("goal", "2D Goal Pose", "Send the robot to a pose.", "g", "pose")
POINT = ToolButton("point", "Point <b>", "Publish a point.", "", "point")
SETTINGS = Settings(fixed_frame="map", views={"kitchen": Orbit()})


def toolbar(tab: Tab) -> playwright.Locator:
    return tab.page.get_by_role("toolbar", name="Tools and view")


@pytest.fixture
def wide(tab: Tab) -> Tab:
    """A tab in which everything fits, with two tools, three frames and one saved view."""
    wide = tab
    wide.page.set_viewport_size({"width": 1600, "height": 900})
    browser = wide.page.evaluate("window.webviz.browser")
    state = replace(
        wide.loop.state,
        tools=(GOAL, POINT),
        frames=("base_link", "map", "odom"),
        fixed_frame="map",
        settings=SETTINGS,
        views={browser: FPS(target_frame="base_link")},
    )
    wide.loop.state = state
    wide.wait_for(lambda: "Point <b>" in toolbar(wide).inner_text())
    wide.wait_for(lambda: "FPS" in toolbar(wide).inner_text())
    return wide


def test_it_shows_the_view_of_this_page_and_the_fixed_frame(wide: Tab) -> None:
    fixed = toolbar(wide).get_by_role("combobox", name="Fixed frame")
    assert fixed.input_value() == "map"
    wide.wait_for(
        lambda: toolbar(wide).get_by_role("combobox", name="Follow").input_value() == "base_link"
    )


@pytest.mark.parametrize(
    ("button", "item", "command"),
    [
        ("View: FPS", "TopDownOrtho", ChangeView("type", "TopDownOrtho")),
        ("View: FPS", "Zero", ResetView()),
        ("Saved views", "kitchen", ShowView("kitchen")),
        ("Saved views", "Start with this view", StartWithView()),
    ],
)
def test_menus_change_the_view(wide: Tab, button: str, item: str, command: Command) -> None:
    wide.button(button).click()
    wide.page.get_by_role("menu").get_by_text(item, exact=True).click()
    wide.wait_for_command(command)


@pytest.mark.parametrize(
    ("field", "command"),
    [("Fixed frame", SetFixedFrame("odom")), ("Follow", ChangeView("target_frame", "odom"))],
)
def test_frames_are_chosen_by_name(wide: Tab, field: str, command: Command) -> None:
    box = toolbar(wide).get_by_role("combobox", name=field)
    box.fill("odom")
    box.press("Enter")
    wide.wait_for_command(command)


def test_a_view_is_saved_under_a_free_name_or_another(wide: Tab) -> None:
    wide.button("Saved views").click()
    wide.page.get_by_role("menuitem", name="Save this view…").click()
    name = wide.page.get_by_role("dialog").get_by_label("Name")
    assert name.input_value() == "View 1"
    name.fill("door")
    name.press("Enter")
    wide.wait_for_command(SaveView("door"))


def test_a_tool_is_chosen_by_its_key_and_left_by_escape(wide: Tab) -> None:
    goal = toolbar(wide).get_by_role("button", name="2D Goal Pose")
    hint = wide.page.locator(".wv-hint")
    wide.page.keyboard.press("g")
    playwright.expect(goal).to_have_attribute("aria-pressed", "true")
    playwright.expect(hint).to_have_text(
        "Press on the ground and drag towards the heading. Ctrl lifts. Esc cancels."
    )
    wide.page.keyboard.press("Escape")
    playwright.expect(goal).to_have_attribute("aria-pressed", "false")
    playwright.expect(hint).to_be_hidden()


def test_arrow_keys_walk_along_the_bar_and_tooltips_tell_keys(wide: Tab) -> None:
    toolbar(wide).get_by_role("button", name="2D Goal Pose").focus()
    wide.page.keyboard.press("ArrowRight")
    playwright.expect(toolbar(wide).get_by_role("button", name="Point <b>")).to_be_focused()
    wide.page.keyboard.press("ArrowLeft")
    tip = wide.page.get_by_role("tooltip")
    playwright.expect(tip).to_contain_text(": Send the robot to a pose.G")
    wide.page.keyboard.press("Escape")
    playwright.expect(tip).to_be_hidden()


def test_what_does_not_fit_is_in_a_menu(wide: Tab) -> None:
    playwright.expect(toolbar(wide).get_by_role("button", name="More")).to_be_hidden()
    wide.page.set_viewport_size({"width": 760, "height": 700})
    toolbar(wide).get_by_role("button", name="More").click()
    items = wide.page.get_by_role("menu")
    playwright.expect(items).to_contain_text("Fixed frame…")
    playwright.expect(items).to_contain_text("Follow…")
    items.get_by_text("Fixed frame…").click()
    box = wide.page.get_by_role("dialog").get_by_role("combobox")
    box.fill("odom")
    box.press("Enter")
    wide.wait_for_command(SetFixedFrame("odom"))
    bar, scene = toolbar(wide).bounding_box(), wide.page.viewport_size
    assert bar is not None
    assert scene is not None
    assert bar["x"] + bar["width"] <= scene["width"]
