"""Several browsers share one viewer."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import viser

from webviz.engine.commands import SetFixedFrame
from webviz.engine.state import File, Row

MakeRow = Callable[..., Row]
OpenTab = Callable[[], Any]


def test_a_change_by_one_is_seen_by_all(
    loop: Any, tab: Any, open_tab: OpenTab, make_row: MakeRow
) -> None:
    loop.show(make_row("a"), make_row("b"))
    other = open_tab()
    tab.fill("Count", "5")
    tab.boxes().nth(1).uncheck()
    other.wait_for(lambda: loop.turn() or other.field("Count").input_value() == "5")
    other.wait_for(lambda: not other.boxes().nth(1).is_checked())
    other.fill("Channel", "ring")
    tab.wait_for(lambda: loop.turn() or tab.field("Channel").input_value() == "ring")


def test_two_who_edit_in_turns_see_the_same(
    loop: Any, tab: Any, open_tab: OpenTab, make_row: MakeRow
) -> None:
    loop.show(make_row("a"))
    editor, watcher = tab, open_tab()
    for value in ("4", "15", "6", "17"):
        editor.fill("Count", value)
        watcher.wait_for(
            lambda value=value, watcher=watcher: (
                loop.turn() or watcher.field("Count").input_value() == value
            )
        )
        editor, watcher = watcher, editor
    assert editor.field("Count").input_value() == "17"


def test_a_browser_that_comes_late_sees_everything_at_once(
    loop: Any, tab: Any, open_tab: OpenTab, make_row: MakeRow
) -> None:
    loop.show(
        make_row("a", count=8, enabled=False),
        file=File("/home/me/lab.yaml", is_changed=True),
        frames=("map", "odom"),
        fixed_frame="odom",
    )
    tab.wait_for(lambda: tab.names() == ["a"])
    late = open_tab()
    late.wait_for(lambda: late.field("Count").input_value() == "8")
    assert late.names() == ["a"]
    assert not late.boxes().first.is_checked()
    assert late.field("Fixed Frame").input_value() == "odom"
    assert "lab.yaml*" in late.text()


def test_a_browser_that_was_cut_off_comes_back_to_how_things_are_now(
    server: viser.ViserServer, loop: Any, tab: Any, make_row: MakeRow
) -> None:
    loop.show(make_row("a"), make_row("gone"))
    tab.wait_for(lambda: tab.names() == ["a", "gone"])
    cut_off = set(server.get_clients())
    for connection in tuple(server._websock_server._live_connections.values()):
        server.get_event_loop().call_soon_threadsafe(connection.transport.abort)
    tab.wait_for(lambda: not cut_off & set(server.get_clients()))
    loop.show(make_row("a", name="renamed", count=9), make_row("new"), fixed_frame="odom")
    tab.wait_for(lambda: tab.names() == ["renamed", "new"])
    tab.wait_for(lambda: tab.field("Count").input_value() == "9")
    tab.wait_for(lambda: tab.field("Fixed Frame").input_value() == "odom")
    tab.wait_for(lambda: bool(server.get_clients()))
    tab.field("Fixed Frame").click()
    tab.page.get_by_role("option", name="odom").wait_for()
    tab.page.keyboard.press("Escape")
    tab.fill("Count", "4")
    tab.wait_for(lambda: loop.turn() or loop.commands)
    assert loop.commands[-1].value == 4


def test_the_dialog_of_a_browser_that_has_gone_is_forgotten(
    server: viser.ViserServer, loop: Any, tab: Any, open_tab: OpenTab
) -> None:
    loop.show(frames=("map", "odom"))
    other = open_tab()
    other.click("By topic")
    other.page.get_by_role("dialog").wait_for()
    known = len(server.get_clients())
    other.page.goto("about:blank")
    tab.wait_for(lambda: len(server.get_clients()) < known)
    loop.show(topics={"/scan": ("sensor_msgs/msg/LaserScan",)})
    tab.field("Fixed Frame").click()
    tab.page.get_by_role("option", name="odom").click()
    tab.wait_for(lambda: loop.turn() or loop.commands)
    assert loop.commands == [SetFixedFrame("odom")]
