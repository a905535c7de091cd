"""The panel "Views": every browser has its own view, the saved ones are shared."""

from __future__ import annotations

from typing import Any

import playwright.sync_api as playwright
import pytest

from tests.page.page_bench import PageBench
from tests.page.tabs import ViewerTab
from webviz.api.views import Orbit, TopDownOrtho
from webviz.commands import (
    ChangeView,
    FocusDisplay,
    RemoveView,
    RenameView,
    ResetView,
    SaveView,
    ShowView,
    StartWithView,
)
from webviz.engine.commands import Sender
from webviz_displays.grid import Grid


class ViewsPane:
    """The panel in one browser."""

    def __init__(self, tab: ViewerTab) -> None:
        self.tab = tab
        self.page = tab.page
        self.viewer = tab.viewer
        self.id = tab.browser

    def open(self) -> ViewsPane:
        self.tab.show_tab("Views")
        self.tab.wait_for(self.field("type").is_visible)
        return self

    def field(self, path: str) -> playwright.Locator:
        return self.page.locator(f"#wv-panel [data-path='{path}']").locator("input").first

    def text(self) -> str:
        return self.page.locator("#wv-panel").inner_text()

    def wait_for_sent(self, command: Any) -> None:
        self.tab.wait_for_command(command)
        assert self.viewer.senders[-1] == Sender(self.id)

    def change(self, **options: Any) -> None:
        """Have a program change the view of this browser."""
        for key, value in options.items():
            self.viewer.do(ChangeView(key, value), Sender(self.id))

    def view(self) -> Any:
        """The view of this browser, as the viewer knows it."""
        return self.viewer.view(self.id)


@pytest.fixture
def views(viewer: PageBench, viewer_tab: ViewerTab) -> ViewsPane:
    viewer.show(Grid(name="Front scan"))
    return ViewsPane(viewer_tab).open()


def test_the_numbers_follow_the_camera_but_not_while_one_types(views: ViewsPane) -> None:
    views.change(distance=3.25, yaw=0.1234567)
    views.tab.wait_for(lambda: views.field("distance").input_value() == "3.25")
    views.tab.wait_for(lambda: views.field("yaw").input_value() == "0.123")
    views.field("distance").fill("4")
    views.change(distance=5.0, yaw=0.5)
    views.tab.wait_for(lambda: views.field("yaw").input_value() == "0.5")
    assert views.field("distance").input_value() == "4"
    views.page.keyboard.press("Enter")
    views.wait_for_sent(ChangeView("distance", 4))
    views.tab.wait_for(lambda: views.view().distance == pytest.approx(4.0, abs=1e-3))


def test_angles_can_be_typed_in_degrees(views: ViewsPane) -> None:
    views.field("yaw").fill("90°")
    views.page.keyboard.press("Enter")
    views.wait_for_sent(ChangeView("yaw", 1.57079632679))


def test_type_and_target_frame_are_chosen_for_this_browser(views: ViewsPane) -> None:
    views.field("type").fill("TopDownOrtho")
    views.field("type").press("Enter")
    views.wait_for_sent(ChangeView("type", "TopDownOrtho"))
    views.field("target_frame").click()
    base = views.page.get_by_role("option", name="base_link", exact=True)
    views.tab.wait_for(base.is_visible)
    base.click()
    views.wait_for_sent(ChangeView("target_frame", "base_link"))
    assert isinstance(views.view(), TopDownOrtho)
    assert views.view().target_frame == "base_link"


def test_a_view_of_another_type_keeps_the_focus_where_it_was(views: ViewsPane) -> None:
    views.field("type").focus()
    views.change(type="FPS")
    views.tab.wait_for(lambda: "Position" in views.text())
    assert views.field("type").evaluate("(field) => field === document.activeElement")


def test_buttons_act_where_they_are_clicked(views: ViewsPane) -> None:
    views.page.locator("#wv-panel").get_by_role("button", name="Zero").click()
    views.wait_for_sent(ResetView())
    views.page.get_by_role("button", name="Start with this", exact=True).click()
    views.wait_for_sent(StartWithView())
    item = views.page.get_by_role("menuitem", name="Front scan")

    def is_offered() -> bool:  # once the page knows the display
        views.page.keyboard.press("Escape")
        views.page.locator("#wv-panel").get_by_role("button", name="Focus").click()
        return item.is_visible()

    views.tab.wait_for(is_offered)
    item.click()
    views.wait_for_sent(FocusDisplay(views.viewer.id("Front scan")))


def save_views(views: ViewsPane, **named: Any) -> None:
    views.viewer.show(views=named)
    element = views.page.locator(".wv-saved-show")
    views.tab.wait_for(lambda: element.count() == len(named))


def test_views_are_saved_under_a_name_or_a_number(views: ViewsPane) -> None:
    save = views.page.get_by_role("button", name="Save", exact=True).last
    for name in ("View 1", "View 2"):
        save.click()
        views.wait_for_sent(SaveView(name))
        views.page.get_by_role("button", name=name, exact=True).wait_for()
    field = views.page.get_by_label("Name of the view to save")
    field.fill("Door")
    field.press("Enter")
    views.wait_for_sent(SaveView("Door"))
    assert list(views.viewer.settings.views) == ["View 1", "View 2", "Door"]


def test_saved_views_are_shown_renamed_begun_with_and_removed(views: ViewsPane) -> None:
    plan = "Plan <b>"
    save_views(views, **{"Door": Orbit(), plan: TopDownOrtho(scale=40.0)})
    views.page.get_by_role("button", name=plan, exact=True).click()
    views.wait_for_sent(ShowView(plan))
    assert isinstance(views.view(), TopDownOrtho)
    views.page.get_by_role("button", name=f"Start with {plan}").click()
    views.wait_for_sent(StartWithView(view=plan))
    assert views.viewer.settings.view == TopDownOrtho(scale=40.0)
    views.page.get_by_role("button", name=f"Rename {plan}").click()
    views.page.keyboard.type("Map")
    views.page.keyboard.press("Enter")
    views.wait_for_sent(RenameView(plan, "Map"))
    button = views.page.get_by_role("button", name="Map", exact=True)
    button.press("F2")
    views.page.keyboard.type("Nothing")
    views.page.keyboard.press("Escape")
    views.page.get_by_role("button", name="Remove Map").click()
    views.wait_for_sent(RemoveView("Map"))
    assert RenameView("Map", "Nothing") not in views.viewer.commands
    assert list(views.viewer.settings.views) == ["Door"]
    save_views(views, Door=Orbit())


def test_a_panel_that_is_not_shown_is_told_nothing(views: ViewsPane) -> None:
    views.tab.show_tab("Displays")
    views.tab.wait_for(lambda: f"view:{views.id}" not in views.viewer.server.channel.watched())
