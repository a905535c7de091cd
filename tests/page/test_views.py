"""The panel "Views": every browser has its own view, the saved ones are shared."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import playwright.sync_api as playwright
import pytest

from tests.page.conftest import Tab
from webviz.api.views import FPS, Orbit, TopDownOrtho
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
from webviz.engine.state import Row
from webviz.files.config import Settings
from webviz.scene.server import Server


class Pane:
    """The panel in one browser."""

    def __init__(self, tab: Tab) -> None:
        self.tab = tab
        self.page = tab.page
        tab.wait_for(lambda: tab.page.evaluate("webviz.browser") is not None)
        self.id: int = tab.page.evaluate("webviz.browser")

    def open(self) -> Pane:
        self.tab.show_tab("Views")
        self.tab.wait_for(self.field("type").is_visible)
        return self

    def field(self, path: str) -> playwright.Locator:
        return self.page.locator(f"#wv-panel [data-path='{path}']").locator("input").first

    def text(self) -> str:
        return self.page.locator("#wv-panel").inner_text()

    def wait_for_sent(self, command: Any) -> None:
        self.tab.wait_for_command(command)
        assert self.tab.loop.senders[-1] == Sender(self.id)


@pytest.fixture
def views(tab: Tab) -> Pane:
    pane = Pane(tab)
    tab.loop.show(views={pane.id: Orbit(distance=15.5)}, frames=("base", "map"))
    return pane.open()


def test_the_numbers_follow_the_camera_but_not_while_one_types(views: Pane) -> None:
    views.tab.loop.show(views={views.id: Orbit(distance=3.25, yaw=0.1234567)})
    views.tab.wait_for(lambda: views.field("distance").input_value() == "3.25")
    assert views.field("yaw").input_value() == "0.123"
    views.field("distance").fill("4")
    views.tab.loop.show(views={views.id: Orbit(distance=5.0, yaw=0.5)})
    views.tab.wait_for(lambda: views.field("yaw").input_value() == "0.5")
    assert views.field("distance").input_value() == "4"
    views.page.keyboard.press("Enter")
    views.wait_for_sent(ChangeView("distance", 4))


def test_angles_can_be_typed_in_degrees(views: Pane) -> None:
    views.field("yaw").fill("90°")
    views.page.keyboard.press("Enter")
    views.wait_for_sent(ChangeView("yaw", 1.57079632679))


def test_type_and_target_frame_are_chosen_for_this_browser(views: Pane) -> None:
    views.field("type").fill("TopDownOrtho")
    views.field("type").press("Enter")
    views.wait_for_sent(ChangeView("type", "TopDownOrtho"))
    views.field("target_frame").click()
    base = views.page.get_by_role("option", name="base", exact=True)
    views.tab.wait_for(base.is_visible)
    base.click()
    views.wait_for_sent(ChangeView("target_frame", "base"))


def test_a_view_of_another_type_keeps_the_focus_where_it_was(views: Pane) -> None:
    views.field("type").focus()
    views.tab.loop.show(views={views.id: FPS()})
    views.tab.wait_for(lambda: "Position" in views.text())
    assert views.field("type").evaluate("(field) => field === document.activeElement")


def test_buttons_act_where_they_are_clicked(views: Pane, make_row: Callable[..., Row]) -> None:
    views.page.locator("#wv-panel").get_by_role("button", name="Zero").click()
    views.wait_for_sent(ResetView())
    views.page.get_by_role("button", name="Start with this", exact=True).click()
    views.wait_for_sent(StartWithView())
    views.tab.loop.show(make_row("a", name="Front scan"))
    item = views.page.get_by_role("menuitem", name="Front scan")

    def is_offered() -> bool:  # once the page knows the display
        views.page.keyboard.press("Escape")
        views.page.locator("#wv-panel").get_by_role("button", name="Focus").click()
        return item.is_visible()

    views.tab.wait_for(is_offered)
    item.click()
    views.wait_for_sent(FocusDisplay("a"))


def saved(views: Pane, **named: Any) -> None:
    views.tab.loop.show(settings=Settings(views=named))
    element = views.page.locator(".wv-saved-show")
    views.tab.wait_for(lambda: element.count() == len(named))


def test_views_are_saved_under_a_name_or_a_number(views: Pane) -> None:
    save = views.page.get_by_role("button", name="Save", exact=True).last
    save.click()
    views.wait_for_sent(SaveView("View 1"))
    saved(views, **{"View 1": Orbit()})
    save.click()
    views.wait_for_sent(SaveView("View 2"))
    field = views.page.get_by_label("Name of the view to save")
    field.fill("Door")
    field.press("Enter")
    views.wait_for_sent(SaveView("Door"))


def test_saved_views_are_shown_renamed_begun_with_and_removed(views: Pane) -> None:
    plan = "Plan <b>"
    saved(views, **{"Door": Orbit(), plan: TopDownOrtho()})
    button = views.page.get_by_role("button", name=plan, exact=True)
    button.click()
    views.wait_for_sent(ShowView(plan))
    views.page.get_by_role("button", name=f"Start with {plan}").click()
    views.wait_for_sent(StartWithView(view=plan))
    views.page.get_by_role("button", name=f"Rename {plan}").click()
    views.page.keyboard.type("Map")
    views.page.keyboard.press("Enter")
    views.wait_for_sent(RenameView(plan, "Map"))
    button.press("F2")
    views.page.keyboard.type("Nothing")
    views.page.keyboard.press("Escape")
    views.page.get_by_role("button", name=f"Remove {plan}").click()
    views.wait_for_sent(RemoveView(plan))
    assert RenameView(plan, "Nothing") not in views.tab.loop.commands
    saved(views, Door=Orbit())


def test_a_panel_that_is_not_shown_is_told_nothing(views: Pane, server: Server) -> None:
    views.tab.show_tab("Displays")
    views.tab.wait_for(lambda: f"view:{views.id}" not in server.channel.watched())
