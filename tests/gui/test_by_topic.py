"""Displays for topics that are published just now."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any

from webviz.api.declared import Topic
from webviz.api.display import Display
from webviz.api.ports import Input
from webviz.edges.gui.add_by_topic import MANY, MAX_SHOWN, NOTHING
from webviz.edges.gui.by_topic import Pick, matching, picks
from webviz.engine.commands import AddDisplay
from webviz.engine.state import Row

GRID, SCAN = "nav_msgs/msg/OccupancyGrid", "sensor_msgs/msg/LaserScan"
UPDATE = "map_msgs/msg/OccupancyGridUpdate"


class Map(Display):
    topic: Annotated[Topic, Input(GRID)] = Topic("/map")
    updates: Annotated[Topic, Input(UPDATE, suffix="_updates")] = Topic()


class Outline(Display):
    source: Annotated[Topic, Input(GRID)] = Topic()


DISPLAYS = {"Outline": Outline, "Map": Map}


def test_every_display_that_fits_is_offered_and_topics_nobody_shows_are_not() -> None:
    topics = {"/map": (GRID,), "/chatter": ("std_msgs/msg/String",), "/map_updates": (UPDATE,)}
    assert picks(topics, DISPLAYS) == [
        Pick("/map", "Map", "topic", GRID),
        Pick("/map", "Outline", "source", GRID),
    ]


def test_a_topic_of_two_types_is_offered_for_the_one_that_can_be_shown() -> None:
    assert [p.message for p in picks({"/map": ("std_msgs/msg/String", GRID)}, {"Map": Map})] == [
        GRID
    ]


def test_a_pick_adds_the_display_with_its_topic() -> None:
    pick = Pick("/map", "Outline", "source", GRID)
    assert pick.command() == AddDisplay("Outline", {"source": "/map"})


def test_the_filter_wants_every_word_somewhere() -> None:
    found = picks({"/map": (GRID,), "/local/costmap": (GRID,)}, DISPLAYS)
    assert [(p.topic, p.display) for p in matching(found, "local OUT")] == [
        ("/local/costmap", "Outline")
    ]
    assert matching(found, "occupancy") == found
    assert matching(found, "") == found
    assert matching(found, "scan") == []


def test_several_topics_are_added_at_once_and_the_last_is_selected(
    loop: Any, tab: Any, make_row: Callable[..., Row]
) -> None:
    row = make_row("a")
    loop.show(row, topics={"/front": (SCAN,), "/rear": (SCAN,), "/map": (GRID,), "/log": ("x/y",)})
    tab.click("By topic")
    tab.page.get_by_text("Add displays by topic").wait_for()
    tab.wait_for(
        lambda: (
            tab.dialog_labels()
            == [
                "/front · LaserScan",
                "/map · Map",
                "/rear · LaserScan",
            ]
        )
    )
    tab.check("/front · LaserScan")
    tab.check("/rear · LaserScan")
    tab.check("/map · Map")
    tab.uncheck("/map · Map")
    tab.dialog_button("Add").click()
    tab.wait_for(lambda: loop.turn() or tab.page.get_by_role("dialog").count() == 0)
    assert loop.commands == [
        AddDisplay("LaserScan", {"topic": "/front"}),
        AddDisplay("LaserScan", {"topic": "/rear"}),
    ]
    loop.show(row, make_row("b"), make_row("c"))
    tab.wait_for(lambda: loop.turn() or tab.field("Name").input_value() == "c")


def test_topics_come_into_an_open_dialog_and_what_was_checked_stays(loop: Any, tab: Any) -> None:
    loop.show()
    tab.click("By topic")
    tab.wait_for(lambda: NOTHING in tab.text())
    loop.show(topics={"/b": (SCAN,)})
    tab.check("/b · LaserScan")
    loop.show(topics={"/a": (SCAN,), "/b": (SCAN,)})
    tab.wait_for(lambda: tab.dialog_labels() == ["/a · LaserScan", "/b · LaserScan"])
    tab.dialog_button("Add").click()
    tab.wait_for(lambda: loop.turn() or loop.commands)
    assert loop.commands == [AddDisplay("LaserScan", {"topic": "/b"})]


def test_of_many_topics_some_are_shown_and_a_filter_finds_the_others(loop: Any, tab: Any) -> None:
    loop.show(topics={f"/robot{i:03}/scan": (SCAN,) for i in range(300)})
    tab.click("By topic")
    tab.wait_for(lambda: len(tab.dialog_labels()) == MAX_SHOWN)
    assert f"… and {300 - MAX_SHOWN} more" in tab.text()
    tab.fill("Filter", "robot299")
    tab.wait_for(lambda: loop.turn() or tab.dialog_labels() == ["/robot299/scan · LaserScan"])
    tab.check("/robot299/scan · LaserScan")
    tab.fill("Filter", "")
    tab.wait_for(lambda: loop.turn() or len(tab.dialog_labels()) == MAX_SHOWN)
    tab.dialog_button("Add").click()
    tab.wait_for(lambda: loop.turn() or loop.commands)
    assert loop.commands == [AddDisplay("LaserScan", {"topic": "/robot299/scan"})]


def test_few_topics_need_no_filter(loop: Any, tab: Any) -> None:
    loop.show(topics={f"/scan{i}": (SCAN,) for i in range(MANY)})
    tab.click("By topic")
    tab.wait_for(lambda: len(tab.dialog_labels()) == MANY)
    assert tab.page.get_by_role("dialog").get_by_text("Filter").count() == 0


def test_a_dialog_is_only_in_the_browser_that_asked(
    loop: Any, tab: Any, open_tab: Callable[[], Any]
) -> None:
    loop.show()
    other = open_tab()
    tab.click("By topic")
    tab.page.get_by_role("dialog").wait_for()
    tab.dialog_button("Cancel").click()
    tab.wait_for(lambda: loop.turn() or tab.page.get_by_role("dialog").count() == 0)
    assert other.page.get_by_role("dialog").count() == 0
    assert loop.commands == []
