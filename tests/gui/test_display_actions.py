"""What is done with displays as a whole, by buttons and keys."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest
import viser

from webviz.api.group import Group
from webviz.engine.commands import (
    Command,
    DuplicateDisplay,
    FocusDisplay,
    MoveDisplay,
    RemoveDisplay,
    Reset,
    Save,
    SaveImage,
    Sender,
    SetBackground,
    SetFrameRate,
    SetProperty,
)
from webviz.engine.state import File, Row
from webviz.files.config import Settings

MakeRow = Callable[..., Row]


def group(id: str, depth: int = 0) -> Row:
    display = Group(name=id)
    return Row(id, "Group", display, display.name, {}, depth)


def test_a_copy_is_selected(loop: Any, tab: Any, make_row: MakeRow) -> None:
    a, b = make_row("a"), make_row("b")
    loop.show(a, b)
    tab.click("Duplicate")
    assert loop.commands == [DuplicateDisplay("a")]
    loop.show(a, make_row("copy"), b)
    tab.wait_for(lambda: loop.turn() or tab.field("Name").input_value() == "copy")


def test_of_a_copied_group_the_group_is_selected(loop: Any, tab: Any, make_row: MakeRow) -> None:
    inner = replace(make_row("inner"), depth=1)
    loop.show(group("robot"), inner)
    tab.click("Duplicate")
    loop.show(group("robot"), inner, group("robot 2"), replace(make_row("inner 2"), depth=1))
    tab.wait_for(lambda: loop.turn() or tab.field("Name").input_value() == "robot 2")


def test_a_look_and_a_picture_are_for_the_browser_that_asks(
    server: viser.ViserServer, loop: Any, tab: Any, open_tab: Callable[[], Any], make_row: MakeRow
) -> None:
    loop.show(make_row("a"))
    first = set(server.get_clients())
    other = open_tab()
    (second,) = set(server.get_clients()) - first
    other.click("Focus")
    other.click("Image")
    assert loop.commands == [FocusDisplay("a"), SaveImage()]
    assert loop.senders == [Sender(second)] * 2


def test_a_display_is_renamed_where_its_name_is_read(
    loop: Any, tab: Any, make_row: MakeRow
) -> None:
    loop.show(make_row("a"))
    tab.fill("Name", "Front laser")
    tab.wait_for(lambda: loop.turn() or loop.commands)
    assert loop.commands == [SetProperty("a", "name", "Front laser")]


def test_displays_are_moved_along_the_list_and_between_groups(
    loop: Any, tab: Any, make_row: MakeRow
) -> None:
    loop.show(make_row("a"), group("robot"), replace(make_row("b"), depth=1), make_row("c"))
    moves: list[tuple[str, str, Command]] = [
        ("c", "Up", MoveDisplay("c", "", "robot")),
        ("a", "Down", MoveDisplay("a", "", "c")),
        ("a", "In", MoveDisplay("a", "robot")),
        ("b", "Out", MoveDisplay("b", "", "c")),
    ]
    for name, way, command in moves:
        tab.page.get_by_role("button", name=name, exact=True).click()
        tab.wait_for(lambda name=name: loop.turn() or tab.field("Name").input_value() == name)
        tab.click(way)
        assert loop.commands.pop() == command
    assert tab.page.get_by_role("button", name="Up", exact=True).is_disabled()
    assert tab.page.get_by_role("button", name="Down", exact=True).is_disabled()


def test_a_group_folds_when_it_is_clicked_again(loop: Any, tab: Any, make_row: MakeRow) -> None:
    inner = replace(make_row("inner"), depth=1)
    loop.show(group("robot"), inner, make_row("c", enabled=False))
    tab.wait_for(lambda: tab.names() == ["▾ robot", "inner", "c"])
    tab.page.get_by_role("button", name="robot").click()
    tab.wait_for(lambda: loop.turn() or tab.names() == ["▸ robot", "c"])
    assert [box.is_checked() for box in tab.boxes().all()] == [True, False]
    tab.page.get_by_role("button", name="robot").click()
    tab.wait_for(lambda: loop.turn() or tab.names() == ["▾ robot", "inner", "c"])


def test_background_and_frame_rate_are_for_everything(loop: Any, tab: Any) -> None:
    loop.show(settings=Settings(background=(1, 2, 3), frame_rate=30.0))
    tab.wait_for(lambda: tab.field("Frame Rate").input_value() == "30")
    tab.fill("Frame Rate", "20")
    tab.wait_for(lambda: loop.drain() or loop.commands)
    assert loop.commands == [SetFrameRate(20.0)]
    assert tab.field("Background").input_value() == "rgb(1, 2, 3)"
    tab.fill("Background", "rgb(255, 0, 10)")
    tab.field("Background").press("Enter")
    tab.wait_for(lambda: loop.drain() or len(loop.commands) == 2)
    assert loop.commands[1] == SetBackground((255, 0, 10))


@pytest.mark.parametrize(
    ("keys", "command"),
    [
        ("Control+s", Save()),
        ("r", Reset()),
        ("Delete", RemoveDisplay("a")),
    ],
)
def test_keys_do_what_rviz_does(
    loop: Any, tab: Any, make_row: MakeRow, keys: str, command: Command
) -> None:
    loop.show(make_row("a"), file=File("/home/me/lab.yaml"))
    tab.wait_for(lambda: tab.names() == ["a"])
    tab.page.keyboard.press(keys)
    tab.wait_for(lambda: loop.drain() or loop.commands)
    assert loop.commands == [command]


@pytest.mark.parametrize(
    ("keys", "title"),
    [
        ("Control+o", "Open"),
        ("Control+Shift+s", "Save as"),
        ("Insert", "Add displays by topic"),
    ],
)
def test_keys_open_dialogs(loop: Any, tab: Any, keys: str, title: str) -> None:
    loop.show()
    tab.page.keyboard.press(keys)
    dialog = tab.page.get_by_role("dialog")
    tab.wait_for(lambda: loop.turn() or dialog.count() == 1)
    assert title in dialog.inner_text()


def test_keys_do_nothing_while_somebody_types(loop: Any, tab: Any, make_row: MakeRow) -> None:
    loop.show(make_row("a", channel=""))
    tab.field("Channel").click()
    tab.page.keyboard.type("r")
    tab.wait_for(lambda: loop.turn() or loop.commands)
    assert loop.commands == [SetProperty("a", "channel", "r")]
