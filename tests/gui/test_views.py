"""The tab "Views": every browser has its own view, the saved ones are shared."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
import viser

from webviz.api.views import FPS, Orbit, TopDownOrtho
from webviz.engine.commands import (
    ChangeView,
    RemoveView,
    ResetView,
    SaveView,
    Sender,
    ShowView,
    StartWithView,
)
from webviz.files.config import Settings


@pytest.fixture
def views(tab: Any, loop: Any, server: viser.ViserServer) -> Any:
    """A tab that shows the views, and the id of its browser."""
    (tab.id,) = server.get_clients()
    loop.show(views={tab.id: Orbit(distance=15.5)}, frames=("base", "map"))
    tab.show_tab("Views")
    tab.page.locator("label:text-is('Distance')").wait_for()
    return tab


def last(loop: Any) -> Any:
    """The last command, and who sent it."""
    loop.drain()
    return (loop.commands[-1], loop.senders[-1]) if loop.commands else None


def test_a_browser_sees_its_own_view_with_its_numbers(
    views: Any, loop: Any, open_tab: Callable[..., Any], server: viser.ViserServer
) -> None:
    other = open_tab()
    (id_,) = set(server.get_clients()) - {views.id}
    loop.show(views={views.id: TopDownOrtho(scale=62.3), id_: FPS(yaw=1.25)})
    other.show_tab("Views")
    views.wait_for(lambda: "Scale" in views.text() and "Distance" not in views.text())
    other.wait_for(lambda: "Position" in other.text() and "Scale" not in other.text())
    assert views.field("Scale").input_value() == "62.3"
    assert other.field("Yaw").input_value() == "1.25"


def test_the_numbers_follow_the_camera(views: Any, loop: Any) -> None:
    loop.show(views={views.id: Orbit(distance=3.25, yaw=0.1234567)})
    views.wait_for(lambda: views.field("Distance").input_value() == "3.25")
    assert views.field("Yaw").input_value() == "0.123"


def test_what_is_changed_is_for_the_browser_in_which_it_is(views: Any, loop: Any) -> None:
    views.fill("Distance", "4")
    views.wait_for(lambda: last(loop) == (ChangeView("distance", 4.0), Sender(views.id)))
    views.field("Type").click()
    views.page.get_by_role("option", name="TopDownOrtho", exact=True).click()
    views.wait_for(lambda: last(loop) == (ChangeView("type", "TopDownOrtho"), Sender(views.id)))
    views.field("Target Frame").click()
    views.page.get_by_role("option", name="base", exact=True).click()
    views.wait_for(lambda: last(loop) == (ChangeView("target_frame", "base"), Sender(views.id)))


@pytest.mark.parametrize(
    ("button", "command"), [("Zero", ResetView), ("Start with this", StartWithView)]
)
def test_buttons_act_where_they_are_clicked(
    views: Any, loop: Any, button: str, command: Callable[[], Any]
) -> None:
    views.click(button)
    views.wait_for(lambda: last(loop) == (command(), Sender(views.id)))


def test_views_are_saved_under_a_name_or_a_number(views: Any, loop: Any) -> None:
    views.click("Save this")
    views.wait_for(lambda: last(loop) == (SaveView("View 1"), Sender(views.id)))
    loop.show(settings=Settings(views={"View 1": Orbit()}))
    views.page.get_by_role("button", name="View 1", exact=True).wait_for()
    views.click("Save this")
    views.wait_for(lambda: last(loop) == (SaveView("View 2"), Sender(views.id)))
    name = views.page.locator(":has(> div > .webviz-row-saved-views) input")
    name.fill("Door")
    views.pause()
    views.click("Save this")
    views.wait_for(lambda: last(loop) == (SaveView("Door"), Sender(views.id)))


def test_saved_views_are_shown_and_removed(views: Any, loop: Any) -> None:
    loop.show(settings=Settings(views={"Door": Orbit(), "Plan <b>": TopDownOrtho()}))
    views.page.get_by_role("button", name="Plan <b>", exact=True).wait_for()
    views.click("Plan <b>")
    views.wait_for(lambda: last(loop) == (ShowView("Plan <b>"), Sender(views.id)))
    views.page.get_by_role("button", name="Remove", exact=True).last.click()
    views.wait_for(lambda: last(loop) == (RemoveView("Plan <b>"), Sender(views.id)))
    loop.show(settings=Settings(views={"Door": Orbit()}))
    views.page.get_by_role("button", name="Plan <b>", exact=True).wait_for(state="detached")


def test_the_key_z_goes_back_to_where_the_view_begins(views: Any, loop: Any) -> None:
    views.page.mouse.click(500, 700)
    views.page.keyboard.press("z")
    views.wait_for(lambda: last(loop) == (ResetView(), Sender(views.id)))
