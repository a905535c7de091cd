"""The panel on a phone, which is touched and has little space."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from webviz.engine.state import Row

WIDTH, HEIGHT = 390, 844
FINGER_PX = 30
"""High enough to be hit with a finger."""


@pytest.fixture
def phone(open_tab: Callable[..., Any]) -> Any:
    return open_tab(WIDTH, HEIGHT, has_touch=True, is_mobile=True)


def top_of_panel(phone: Any) -> float:
    return phone.page.get_by_text("webviz", exact=True).bounding_box()["y"]


def test_half_of_the_scene_stays_free_and_a_tap_frees_the_rest(
    loop: Any, phone: Any, make_row: Callable[..., Row]
) -> None:
    loop.show(*(make_row(str(i)) for i in range(30)))
    phone.wait_for(lambda: len(phone.names()) == 30)
    phone.wait_for(lambda: 0.38 * HEIGHT < top_of_panel(phone) < 0.5 * HEIGHT)
    phone.page.get_by_text("webviz", exact=True).tap()
    phone.wait_for(lambda: top_of_panel(phone) > 0.9 * HEIGHT)
    phone.page.get_by_text("webviz", exact=True).tap()
    phone.wait_for(lambda: top_of_panel(phone) < 0.5 * HEIGHT)


def test_the_panel_uses_the_width_and_its_buttons_can_be_hit(
    loop: Any, phone: Any, make_row: Callable[..., Row]
) -> None:
    loop.show(make_row("a"), make_row("b"))
    phone.wait_for(lambda: phone.names() == ["a", "b"])
    for name in ("Save", "Reset", "By topic", "a", "b", "Duplicate", "Out"):
        box = phone.page.get_by_role("button", name=name, exact=True).bounding_box()
        assert box["height"] >= FINGER_PX, name
        assert box["width"] >= FINGER_PX, name
        assert box["x"] >= 0, name
        assert box["x"] + box["width"] <= WIDTH, name
    last = phone.page.get_by_role("button", name="Reset", exact=True).bounding_box()
    first = phone.page.get_by_role("button", name="Save", exact=True).bounding_box()
    assert last["x"] + last["width"] - first["x"] > 0.85 * WIDTH


def test_a_display_is_edited_by_touch(loop: Any, phone: Any, make_row: Callable[..., Row]) -> None:
    loop.show(make_row("a"), make_row("b", channel="second"))
    phone.page.get_by_role("button", name="b", exact=True).tap()
    phone.wait_for(lambda: loop.turn() or phone.field("Channel").input_value() == "second")
    phone.boxes().nth(1).tap()
    phone.wait_for(lambda: loop.turn() or loop.commands)
    assert [command.value for command in loop.commands] == [False]
