"""The toolbar over the scene."""

from __future__ import annotations

import playwright.sync_api as playwright
import pytest
from pages import bounds

from tests.page.page_bench import PageBench
from tests.page.tabs import ViewerTab
from webviz.api.views import FPS, Orbit, TopDownOrtho, View
from webviz.commands import (
    AddDisplay,
    ChangeView,
    FocusFrame,
    ResetView,
    SaveView,
    SetFixedFrame,
    ShowView,
    StartWithView,
)
from webviz.engine.commands import Command, Sender
from webviz.features.tools.toolbar import ToolButton
from webviz.tools.goal_pose import GoalPose
from webviz.tools.publish_point import PublishPoint

GOAL = ToolButton("goal", "2D Goal Pose", "Send the robot to a pose.", "g", "pose")
POINT = ToolButton("point", "Point <b>", "Publish a point.", "", "point")


def toolbar(tab: ViewerTab) -> playwright.Locator:
    return tab.page.get_by_role("toolbar", name="Tools and view")


@pytest.fixture
def wide(viewer: PageBench, viewer_tab: ViewerTab) -> ViewerTab:
    """A tab in which everything fits, with two tools, three frames and one saved view."""
    wide = viewer_tab
    wide.page.set_viewport_size({"width": 1600, "height": 900})
    viewer.link("map", "odom")
    tools = [GoalPose(name=GOAL.name), PublishPoint(name=POINT.name)]
    viewer.show(tools=tools, views={"kitchen": Orbit(distance=3.0)})
    viewer.do(ChangeView("type", "FPS"), Sender(wide.browser))
    viewer.do(ChangeView("target_frame", "base_link"), Sender(wide.browser))
    wide.wait_for(lambda: "Point <b>" in toolbar(wide).inner_text())
    wide.wait_for(lambda: "FPS" in toolbar(wide).inner_text())
    return wide


def test_it_shows_the_view_of_this_page_and_the_fixed_frame(wide: ViewerTab) -> None:
    fixed = toolbar(wide).get_by_role("combobox", name="Fixed frame")
    assert fixed.input_value() == "map"
    wide.wait_for(
        lambda: toolbar(wide).get_by_role("combobox", name="Follow").input_value() == "base_link"
    )


@pytest.mark.parametrize(
    ("button", "item", "command", "view"),
    [
        ("View: FPS", "TopDownOrtho", ChangeView("type", "TopDownOrtho"), TopDownOrtho),
        ("View: FPS", "Zero", ResetView(), FPS),
        ("Saved views", "kitchen", ShowView("kitchen"), Orbit),
        ("Saved views", "Start with this view", StartWithView(), FPS),
    ],
)
def test_menus_change_the_view(
    wide: ViewerTab, button: str, item: str, command: Command, view: type[View]
) -> None:
    wide.button(button).click()
    wide.page.get_by_role("menu").get_by_text(item, exact=True).click()
    wide.wait_for_command(command)
    assert isinstance(wide.viewer.view(wide.browser), view)
    starts = isinstance(wide.viewer.settings.view, FPS)
    assert starts == (item == "Start with this view")


@pytest.mark.parametrize(
    ("field", "commands"),
    [
        ("Fixed frame", [SetFixedFrame("odom")]),
        ("Follow", [ChangeView("target_frame", "odom"), FocusFrame("odom")]),
    ],
)
def test_frames_are_chosen_by_name_and_the_followed_one_is_centered(
    wide: ViewerTab, field: str, commands: list[Command]
) -> None:
    box = toolbar(wide).get_by_role("combobox", name=field)
    box.fill("odom")
    box.press("Enter")
    wide.wait_for(lambda: wide.viewer.commands == commands)
    frames = wide.viewer.settings.fixed_frame, wide.viewer.view(wide.browser).target_frame
    assert frames == (("odom", "base_link") if field == "Fixed frame" else ("map", "odom"))


@pytest.mark.parametrize(
    ("field", "before", "name", "reason"),
    [
        ("Fixed frame", "map", "/", "The fixed frame needs a name."),
        ("Follow", "base_link", "x" * 100_001, "expected at most 100000 characters"),
    ],
)
def test_a_frame_that_the_viewer_refuses_does_not_stay_in_the_field(
    wide: ViewerTab, field: str, before: str, name: str, reason: str
) -> None:
    box = toolbar(wide).get_by_role("combobox", name=field)
    playwright.expect(box).to_have_value(before)  # not that of the test before
    box.fill(name)
    box.press("Enter")
    wide.wait_for(lambda: reason in wide.text())
    playwright.expect(box).to_have_value(before)
    playwright.expect(box).not_to_have_attribute("aria-invalid", "true")


def test_what_is_typed_replaces_a_frame_that_came_after_the_field_was_entered(
    wide: ViewerTab,
) -> None:
    box = toolbar(wide).get_by_role("combobox", name="Fixed frame")
    playwright.expect(box).to_have_value("map")
    box.focus()
    wide.viewer.do(SetFixedFrame("odom"))
    playwright.expect(box).to_have_value("odom")
    wide.page.keyboard.type("base_link")
    playwright.expect(box).to_have_value("base_link")


@pytest.mark.parametrize("field", ["Follow", "Fixed frame"])
def test_the_list_of_commands_leads_to_the_fields_of_frames(wide: ViewerTab, field: str) -> None:
    wide.page.keyboard.press("Control+k")
    wide.page.get_by_role("dialog").get_by_role("combobox").fill(field)
    wide.page.keyboard.press("Enter")
    playwright.expect(toolbar(wide).get_by_role("combobox", name=field)).to_be_focused()


def test_a_view_is_saved_under_a_free_name_or_another(wide: ViewerTab) -> None:
    wide.button("Saved views").click()
    wide.page.get_by_role("menuitem", name="Save this view…").click()
    name = wide.page.get_by_role("dialog").get_by_label("Name")
    assert name.input_value() == "View 1"
    name.fill("door")
    name.press("Enter")
    wide.wait_for_command(SaveView("door"))


def test_a_tool_is_chosen_by_its_key_and_left_by_escape(wide: ViewerTab) -> None:
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


def test_arrow_keys_walk_along_the_bar_and_tooltips_tell_keys(wide: ViewerTab) -> None:
    goal, point = (
        toolbar(wide).get_by_role("button", name=name) for name in ("2D Goal Pose", "Point <b>")
    )

    def walk() -> bool:
        goal.focus()
        wide.page.keyboard.press("ArrowRight")
        return point.evaluate("button => button === document.activeElement")

    wide.wait_for(walk)  # the tools of the test before may still be there, and go
    wide.page.keyboard.press("ArrowLeft")
    tip = wide.page.get_by_role("tooltip")
    playwright.expect(tip).to_have_text(
        "2D Goal Pose: Send the robot to a pose: press at the position, drag towards the heading.G"
    )
    wide.page.keyboard.press("Escape")
    playwright.expect(tip).to_be_hidden()


@pytest.mark.parametrize(("width", "image"), [(620, 0), (700, 0), (1000, 0), (700, 1), (900, 1)])
def test_what_does_not_fit_is_in_a_menu_but_frames_and_tools_stay(
    wide: ViewerTab, width: int, image: int
) -> None:
    wide.page.evaluate("localStorage.setItem('webviz.tool-uses', '3')")  # no words below tools
    wide.page.reload()
    bar = toolbar(wide)
    wide.wait_for(lambda: "Point <b>" in bar.inner_text())
    playwright.expect(bar.get_by_role("button", name="More")).to_be_hidden()
    for _ in range(image):
        wide.viewer.do(AddDisplay("Image"))
    wide.turn()
    playwright.expect(
        wide.page.get_by_role("region", name="Image /camera/image_raw")
    ).to_have_count(image)
    wide.page.set_viewport_size({"width": width, "height": 700})
    bar.get_by_role("button", name="More").click()
    wide.page.get_by_role("menuitem", name="Full screen").wait_for()
    wide.page.keyboard.press("Escape")
    assert overflow(bar) == []
    box = bounds(bar)
    assert box["height"] < 80, "more than two lines"
    for name in ("Fixed frame", "Follow"):
        box = bar.get_by_role("combobox", name=name)
        playwright.expect(box).to_be_in_viewport(ratio=1)
    for tool in (GOAL, POINT):
        playwright.expect(bar.get_by_role("button", name=tool.name)).to_be_in_viewport(ratio=1)


def overflow(bar: playwright.Locator) -> list[str]:
    """Return the parts of the toolbar outside of its box."""
    return bar.evaluate(
        """(bar) => {
          const box = bar.getBoundingClientRect();
          return [...bar.querySelectorAll("button, input")]
            .filter((one) => one.checkVisibility())
            .map((one) => [one.ariaLabel, one.getBoundingClientRect()])
            .filter(([, r]) => r.left < box.left || r.right > box.right || r.bottom > box.bottom)
            .map(([name]) => name);
        }"""
    )
