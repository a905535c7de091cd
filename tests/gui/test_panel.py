"""The panel in real browsers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
import viser

from webviz.api.declared import Topic
from webviz.api.registry import display_types
from webviz.api.status import Level, Status
from webviz.edges.gui import Panels
from webviz.engine.commands import AddDisplay, RemoveDisplay, Reset, SetFixedFrame, SetProperty
from webviz.engine.state import Row

MakeRow = Callable[..., Row]


def test_a_check_box_enables_its_display(loop: Any, tab: Any, make_row: MakeRow) -> None:
    loop.show(make_row("a"), make_row("b"))
    tab.boxes().nth(1).uncheck()
    tab.wait_for(lambda: loop.drain() or loop.commands)
    assert loop.commands == [SetProperty("b", "enabled", False)]


def test_the_first_display_is_selected_and_a_click_on_a_name_selects_another(
    loop: Any, tab: Any, make_row: MakeRow
) -> None:
    loop.show(make_row("a", channel="first"), make_row("b", channel="second"))
    tab.wait_for(lambda: tab.field("Channel").input_value() == "first")
    tab.page.get_by_role("button", name="b", exact=True).click()
    tab.wait_for(lambda: loop.turn() or tab.field("Channel").input_value() == "second")
    assert loop.commands == []


def test_what_is_entered_becomes_a_command_of_the_right_type(
    loop: Any, tab: Any, make_row: MakeRow
) -> None:
    loop.show(make_row("a"))
    tab.fill("Size (m)", "0.25")
    tab.fill("Count", "7")
    tab.field("Filled").uncheck()
    tab.pause()
    tab.fill("Channel", "ring")
    tab.fill("Length (m)", "2")
    tab.fill("Offset", "1.5")
    tab.fill("Shown", "base_link: false")
    tab.wait_for(lambda: loop.turn() or len({c.path for c in loop.commands}) == 7)
    assert {c.path: c.value for c in loop.commands} == {
        "size": 0.25,
        "count": 7,
        "filled": False,
        "channel": "ring",
        "arrow.length": 2.0,
        "offset": (1.5, 0.5, 0.0),
        "shown": {"base_link": False},
    }
    display = loop.state.rows[0].display
    assert (display.size, display.count, display.arrow.length) == (0.25, 7, 2.0)


def test_text_counts_when_typing_pauses_not_by_the_letter(
    loop: Any, tab: Any, make_row: MakeRow
) -> None:
    loop.show(make_row("a"))
    tab.fill("Channel", "")
    tab.field("Channel").press_sequentially("ring", delay=20)
    tab.wait_for(lambda: loop.turn() or loop.commands)
    assert loop.commands == [SetProperty("a", "channel", "ring")]


def test_choices_offer_live_topics_of_the_type_and_known_frames(
    loop: Any, tab: Any, make_row: MakeRow
) -> None:
    topics = {
        "/front": ("sensor_msgs/msg/LaserScan",),
        "/map": ("nav_msgs/msg/OccupancyGrid",),
    }
    loop.show(make_row("a"), frames=("base_link", "odom"), topics=topics)
    tab.field("Topic").click()
    assert tab.page.get_by_role("option").all_inner_texts() == ["/front", "/scan"]
    tab.page.get_by_role("option", name="/front").click()
    tab.wait_for(lambda: loop.turn() or loop.commands)
    assert loop.commands == [SetProperty("a", "topic.name", "/front")]
    assert loop.state.rows[0].display.topic == Topic("/front")
    tab.field("Frame").click()
    assert tab.page.get_by_role("option").all_inner_texts() == [
        "<Fixed Frame>",
        "base_link",
        "odom",
    ]


def test_the_fixed_frame_is_chosen_from_known_frames_and_its_status_is_read(
    loop: Any, tab: Any
) -> None:
    status = {"Fixed Frame": Status(Level.WARN, "No frame is called map.")}
    loop.show(frames=("base_link", "odom"), statuses=status)
    tab.wait_for(lambda: "Fixed Frame: No frame is called map." in tab.text())
    tab.field("Fixed Frame").click()
    assert tab.page.get_by_role("option").all_inner_texts() == ["base_link", "odom", "map"]
    tab.page.get_by_role("option", name="odom").click()
    tab.wait_for(lambda: loop.drain() or loop.commands)
    assert loop.commands == [SetFixedFrame("odom")]


@pytest.mark.parametrize("leave", ["Enter", "Tab"])
def test_a_frame_that_does_not_exist_can_be_typed_and_stays(
    loop: Any, tab: Any, make_row: MakeRow, leave: str
) -> None:
    loop.show(make_row("a"), frames=("base_link", "odom"))
    tab.wait_for(lambda: tab.names() == ["a"])
    for label, command in (
        ("Fixed Frame", SetFixedFrame("bass")),
        ("Frame", SetProperty("a", "frame", "bass")),
    ):
        loop.commands.clear()
        tab.field(label).fill("bass")
        tab.field(label).press(leave)
        tab.wait_for(lambda: loop.drain() or loop.commands)
        assert loop.commands == [command]
    loop.show(make_row("a", frame="bass"), fixed_frame="bass")
    fields = [tab.field(label) for label in ("Fixed Frame", "Frame")]
    tab.wait_for(lambda: loop.turn() or {f.input_value() for f in fields} == {"bass"})


def test_a_text_typed_for_searching_is_forgotten_after_escape_and_a_choice(
    loop: Any, tab: Any
) -> None:
    loop.show(frames=("base_link", "odom"))
    tab.field("Fixed Frame").fill("bas")
    tab.field("Fixed Frame").press("Escape")
    tab.field("Fixed Frame").press("Tab")
    tab.field("Fixed Frame").fill("od")
    tab.page.get_by_role("option", name="odom").click()
    tab.wait_for(lambda: loop.drain() or loop.commands)
    tab.page.wait_for_timeout(300)
    loop.drain()
    assert loop.commands == [SetFixedFrame("odom")]


def test_a_refused_value_is_set_back(loop: Any, tab: Any, make_row: MakeRow) -> None:
    loop.show(make_row("a"))
    tab.fill("Size (m)", "0")
    tab.wait_for(lambda: loop.turn() or loop.commands)
    assert loop.commands == [SetProperty("a", "size", 0.0)]
    tab.wait_for(lambda: loop.turn() or tab.field("Size (m)").input_value() == "0.01")
    assert len(loop.commands) == 1


def test_a_text_that_means_nothing_is_set_back_with_the_reason(
    loop: Any, tab: Any, make_row: MakeRow
) -> None:
    loop.show(make_row("a", shown={"base_link": True}))
    tab.fill("Shown", "base_link: perhaps")
    tab.wait_for(lambda: loop.turn() or "'perhaps' is not valid" in tab.text())
    tab.wait_for(lambda: loop.turn() or tab.field("Shown").input_value() == "base_link: true")
    assert loop.commands == []


def test_a_viewer_that_lags_behind_does_not_pull_a_value_back(
    loop: Any, tab: Any, make_row: MakeRow
) -> None:
    loop.show(make_row("a"))
    tab.fill("Count", "9")
    tab.wait_for(lambda: loop.drain() or loop.commands)
    frames = tab.frames_received
    loop.panel.update(loop.state)
    tab.page.wait_for_timeout(100)
    assert tab.field("Count").input_value() == "9"
    assert tab.frames_received == frames


def test_a_change_from_elsewhere_is_shown_and_asks_for_nothing(
    loop: Any, tab: Any, make_row: MakeRow
) -> None:
    row = make_row("a")
    loop.show(row)
    tab.wait_for(lambda: tab.field("Count").input_value() == "3")
    display: Any = row.display
    display.count, display.style, display.enabled = 8, "Boxes", False
    loop.turn()
    tab.wait_for(lambda: tab.field("Count").input_value() == "8")
    assert tab.field("Style").input_value() == "Boxes"
    assert not tab.boxes().first.is_checked()
    tab.page.wait_for_timeout(100)
    loop.drain()
    assert loop.commands == []


def test_to_show_a_value_with_more_digits_than_fit_does_not_change_it(
    loop: Any, tab: Any, make_row: MakeRow
) -> None:
    loop.show(make_row("a", size=0.123456789, alpha=0.123456789, offset=(0.123456789, 0.0, 1e9)))
    tab.wait_for(lambda: tab.field("Size (m)").input_value() == "0.123457")
    for label in ("Size (m)", "Offset", "Count"):
        tab.field(label).click()
    tab.page.wait_for_timeout(300)
    loop.drain()
    assert loop.commands == []


def test_properties_that_do_not_apply_are_hidden(loop: Any, tab: Any, make_row: MakeRow) -> None:
    row = make_row("a")
    loop.show(row)
    tab.field("Style").wait_for()
    assert tab.field("Edge").count() == 0
    display: Any = row.display
    display.style = "Boxes"
    loop.turn()
    tab.field("Edge").wait_for()
    assert tab.field("Edge").input_value() == "0.5"


def test_nothing_is_sent_while_nothing_changes(loop: Any, tab: Any, make_row: MakeRow) -> None:
    loop.show(make_row("a", statuses={"Topic": Status(Level.OK, "12 Hz")}))
    tab.field("Count").wait_for()
    tab.page.wait_for_timeout(300)
    frames = tab.frames_received
    for _ in range(20):
        loop.turn()
    tab.page.wait_for_timeout(300)
    assert tab.frames_received == frames


def test_hostile_text_is_shown_as_it_is(loop: Any, tab: Any, make_row: MakeRow) -> None:
    hostile = "<img src=x onerror=alert(1)>"
    markdown = "`a` [b](javascript:alert(1)) **c**"
    statuses = {hostile: Status(Level.ERROR, f"{markdown} <script>alert(2)</script>")}
    row = make_row("a", name=hostile, statuses=statuses, channel=hostile)
    loop.show(
        row,
        fixed_frame=hostile,
        frames=(hostile, "\ud800", "two\nlines"),
        topics={hostile: ("sensor_msgs/msg/LaserScan",)},
        statuses=statuses,
    )
    tab.wait_for(lambda: tab.names() == [f"✖ {hostile}"])
    assert tab.text().count(f"✖ {hostile}: {markdown} <script>alert(2)</script>") == 2
    assert tab.field("Fixed Frame").input_value() == hostile
    assert tab.field("Channel").input_value() == hostile
    tab.field("Topic").click()
    assert hostile in tab.page.get_by_role("option").all_inner_texts()
    tab.page.wait_for_timeout(200)
    assert tab.page.locator("img[src=x]").count() == 0
    assert tab.errors == []


def test_an_entry_that_cannot_be_read_shows_why_and_nothing_to_edit(loop: Any, tab: Any) -> None:
    reason = Status(
        Level.ERROR, "displays[0]: unknown display type `Grd` here, did you mean `Grid`?"
    )
    loop.show(Row("a", "Grd", None, "Ground", {"Config": reason}))
    tab.wait_for(lambda: reason.text in tab.text())
    assert tab.names() == ["✖ Ground"]
    assert tab.boxes().first.is_disabled()
    tab.page.get_by_role("button", name="Remove").click()
    tab.wait_for(lambda: loop.drain() or loop.commands)
    assert loop.commands == [RemoveDisplay("a")]


def test_a_removed_display_leaves_its_neighbour_selected(
    loop: Any, tab: Any, make_row: MakeRow
) -> None:
    a, b = make_row("a"), make_row("b", channel="neighbour")
    loop.show(a, b)
    tab.wait_for(lambda: tab.names() == ["a", "b"])
    loop.show(b)
    tab.wait_for(lambda: tab.names() == ["b"])
    tab.wait_for(lambda: tab.field("Channel").input_value() == "neighbour")


def test_displays_are_listed_in_the_order_of_the_viewer(
    loop: Any, tab: Any, make_row: MakeRow
) -> None:
    a, b, c = make_row("a"), make_row("b"), make_row("c", enabled=False)
    loop.show(a, b)
    loop.show(c, b, a)
    tab.wait_for(lambda: tab.names() == ["c", "b", "a"])
    assert [box.is_checked() for box in tab.boxes().all()] == [False, True, True]


def test_an_added_display_of_the_chosen_type_is_selected(
    loop: Any, tab: Any, make_row: MakeRow
) -> None:
    loop.show(make_row("a"))
    tab.page.get_by_role("button", name="Add").click()
    tab.wait_for(lambda: loop.drain() or loop.commands)
    assert loop.commands == [AddDisplay(next(iter(display_types())))]
    loop.show(make_row("a"), make_row("b", channel="new"), make_row("c"))
    loop.show(make_row("a"), make_row("b"), make_row("c", channel="newest"))
    tab.wait_for(lambda: tab.field("Name").input_value() == "c")


def test_reset_is_one_click(loop: Any, tab: Any) -> None:
    loop.show()
    tab.page.get_by_role("button", name="Reset").click()
    tab.wait_for(lambda: loop.drain() or loop.commands)
    assert loop.commands == [Reset()]


def test_a_panel_without_displays_can_be_shown(server: viser.ViserServer) -> None:
    commands: list[Any] = []
    assert isinstance(Panels(server, lambda command, sender: commands.append(command)), Panels)
