"""Selections of browsers: found in what they show, and asked of the display."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Annotated, Any

import numpy as np
import pytest

from webviz import Context, Details, Display, Hit, Input, Quantity, Sample, Topic
from webviz.commands import Identify, InspectSelections, RemoveDisplay, Select, SetProperty
from webviz.engine.commands import Picks, Sender
from webviz.features.selection import MAX_PAST, MAX_SELECTED

SECOND = 1_000_000_000
PAGE, OTHER = Sender(1), Sender(2)
DOTS = "display1/topic.0/"

Benches = Callable[..., Any]


class Dots(Display):
    """A red and a green point for each pose, at its x."""

    topic: Annotated[Topic, Input("geometry_msgs/msg/PoseStamped")] = Topic("/pose")
    asked: int = 0

    def draw(self, sample: Sample, ctx: Context) -> None:
        x = sample.message.pose.position.x
        ctx.points("dots", [[x, 0, 0], [x, 1, 0]], [(255, 0, 0), (0, 255, 0)], 0.1)

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        self.asked += 1
        x = hit.sample.message.pose.position.x
        now = f"{ctx.frames.now_ns}"
        return Details(f"Dot {hit.id}", {"x": x, "Way": Quantity(x / 2, "km"), "Now": now})


class Moving(Display):
    """A point that is asked where it is."""

    def tick(self, ctx: Context) -> None:
        ctx.points("dot", [[ctx.frames.now_ns / 1e9, 0, 0]], (0, 0, 0), 0.1)

    def inspect(self, hit: Hit, ctx: Context) -> Details | None:
        return Details("Clock", {"Time": ctx.frames.now_ns // SECOND}) if self.enabled else None


def dot(x: float, number: int = 1, id: int = 5) -> Picks:
    """One of the two dots as a browser has it."""
    color = [(255, 0, 0), (0, 255, 0)][number]
    return Picks(DOTS, "dots", ((id, number, (x, float(number), 0.0), color),))


@pytest.fixture
def shown(bench: Benches) -> Any:
    """A viewer with a pose at x = 1, and page 1 looking at its selection."""
    b = bench(Dots(name="Pair"), Moving(name="Clock"))
    b.source.now = 100 * SECOND
    b.transform("map", "base", 0, static=True)
    b.do(InspectSelections(frozenset({1, 2}), frozenset({1}), is_picking=True))
    pose(b, 1.0)
    return b


def pose(b: Any, x: float) -> None:
    b.source.now += SECOND // 10
    b.clock += 0.1
    b.pose("/pose", "base", b.source.now, x)
    b.turn()


def told(b: Any, browser: int = 1) -> Any:
    """Return what the panel shows of the only selected item."""
    b.turn(keep_up=True)
    things = {key: each for key, each in b.states[-1].selections[browser].items() if key != "/info"}
    return things.popitem()[1] if len(things) == 1 else things


def test_a_display_is_asked_what_was_selected_and_whose_it_is_is_added(shown: Any) -> None:
    state = shown.do(Select((dot(1.0),), total=1), PAGE)
    thing = told(shown)
    assert (thing["display"], thing["name"], thing["title"]) == ("display1", "Pair", "Dot 1")
    values = thing["tree"]["fields"]
    assert (values["x"], values["Position in map"]) == ("1", "1.0000, 1.0000, 0.0000 m")
    assert (values["Frame"], values["Stamp"]) == ("base", "100.100000 s")
    assert state.selected == {1: {5: ("display1", False)}}


def test_a_picture_that_was_replaced_is_answered_from_what_was_on_the_screen(shown: Any) -> None:
    for x in (2.0, 3.0):
        pose(shown, x)
    shown.do(Select((dot(2.0),), total=1), PAGE)
    thing = told(shown)
    assert thing["tree"]["fields"]["x"] == "2"
    assert thing["note"].startswith("A newer message has replaced this one")


@pytest.mark.parametrize(
    "picks",
    [
        dot(7.0),
        Picks(DOTS, "dots", ((5, 1, (1.0, 1.0, 0.0), (255, 0, 0)),)),
        Picks(DOTS, "dots", ((5, 1, (1.0, 1.0, 0.0), None),)),
        Picks(DOTS, "dots", ((5, 2, (1.0, 1.0, 0.0), (0, 255, 0)),)),
        Picks(DOTS, "dots", ((5, 10**18, (1.0, 1.0, 0.0), (0, 255, 0)),)),
        Picks(DOTS, "dots", ((5, 10**30, (1.0, 1.0, 0.0), (0, 255, 0)),)),
        Picks(DOTS, "dots", ((5, -1, (1.0, 1.0, 0.0), (0, 255, 0)),)),
        Picks(DOTS, "dots", ((5, None, (1.0, 1.0, 0.0), (0, 255, 0)),)),
        Picks(DOTS, "dots", ((5, 1, (math.nan, math.nan, math.nan), (0, 255, 0)),)),
        Picks(DOTS, "dots", ((5, 1, (math.inf, 1e308, -1e308), (0, 255, 0)),)),
        Picks(DOTS, "other", dot(1.0).items),
        Picks("display1/../topic.0/", "dots", dot(1.0).items),
        Picks("display1", "dots", dot(1.0).items),
        Picks("display9/topic.0/", "dots", dot(1.0).items),
        Picks("", "", dot(1.0).items),
        Picks("/" * 1000, "\0", dot(1.0).items),
    ],
)
def test_what_no_browser_can_have_seen_is_not_found(shown: Any, picks: Picks) -> None:
    before = shown.states[-1].selected
    answer = shown.viewer.enqueue(Select((picks,), total=1), PAGE)
    shown.until_done(answer)
    assert str(answer.exception(0)) == "It has been replaced since the click. Click again."
    assert shown.ask(Identify(picks)) == ""
    assert shown.states[-1].selected == before


def test_one_line_answers_what_is_under_the_pointer(shown: Any) -> None:
    assert shown.ask(Identify(dot(1.0, 0))) == "Pair · Dot 0 · x 1"


def test_the_past_is_kept_only_while_somebody_is_about_to_select(shown: Any) -> None:
    pose(shown, 2.0)
    shown.do(InspectSelections(frozenset({1}), frozenset({1})))
    assert shown.ask(Identify(dot(1.0))) == ""
    assert shown.ask(Identify(dot(2.0))) != ""


def test_values_stay_up_to_date_while_they_are_looked_at_and_only_then(shown: Any) -> None:
    shown.source.now = 200 * SECOND
    shown.turn()
    clock = Picks("display2/tick/", "dot", ((1, 0, (200.0, 0.0, 0.0), None),))
    shown.do(Select((clock, dot(1.0)), total=2), PAGE)
    shown.source.now, shown.clock = 300 * SECOND, shown.clock + 1.0
    assert {thing["tree"]["fields"].get("Time") for thing in told(shown).values()} == {"300", None}
    display = shown.states[-1].rows[0].display
    shown.do(InspectSelections(frozenset({1}), frozenset()))
    asked = display.asked
    shown.clock += 1.0
    assert told(shown) == {}
    assert display.asked == asked


def test_browsers_select_each_for_themselves_until_they_leave(shown: Any) -> None:
    shown.do(Select((dot(1.0),), total=1), PAGE)
    shown.do(Select((dot(1.0, 0, id=9),), total=1), OTHER)
    assert {browser: [*things] for browser, things in shown.states[-1].selected.items()} == {
        1: [5],
        2: [9],
    }
    state = shown.do(InspectSelections(frozenset({2}), frozenset()))
    assert [*state.selected] == [2]


def test_more_is_added_and_some_is_kept(shown: Any) -> None:
    shown.do(Select((dot(1.0),), total=1), PAGE)
    state = shown.do(Select((dot(1.0, 0, id=6),), keep=(5, 77), total=2), PAGE)
    assert [*state.selected[1]] == [5, 6]
    assert [*shown.do(Select(keep=(6,), total=1), PAGE).selected[1]] == [6]
    assert shown.do(Select(), PAGE).selected == {}


def test_a_selection_has_a_limit(shown: Any) -> None:
    items = tuple((id, 1, (1.0, 1.0, 0.0), (0, 255, 0)) for id in range(MAX_SELECTED + 1))
    answer = shown.viewer.enqueue(Select((Picks(DOTS, "dots", items),)), PAGE)
    shown.until_done(answer)
    assert str(answer.exception(0)) == "Select at most 1000 things at once."
    shown.do(Select((Picks(DOTS, "dots", items[:-1]),), total=50_000), PAGE)
    info = shown.states[-1].selections[1]["/info"]
    assert (info["count"], info["total"]) == (1000, 50_000)


def test_statistics_are_of_the_numbers_of_each_display(shown: Any) -> None:
    first, second = (Picks(DOTS, "dots", dot(1.0, number, number).items) for number in (0, 1))
    shown.do(Select((first,), total=1), PAGE)
    assert "displays" not in shown.states[-1].selections[1]["/info"]
    pose(shown, 4.0)
    third = dot(4.0, 1, 2)
    shown.do(Select((second, third), keep=(0,), total=3), PAGE)
    (display,) = shown.states[-1].selections[1]["/info"]["displays"]
    assert (display["name"], display["count"]) == ("Pair", 3)
    assert [tuple(each.values()) for each in display["ranges"]] == [
        ("x in map", "m", 1.0, 4.0, 2.0),
        ("y in map", "m", 0.0, 1.0, pytest.approx(2 / 3)),
        ("z in map", "m", 0.0, 0.0, 0.0),
        ("x", "", 1.0, 4.0, 2.0),
        ("Way", "km", 0.5, 2.0, 1.0),
    ]


def test_only_so_many_replaced_messages_are_held(shown: Any) -> None:
    """A program could otherwise hold every cloud that ever came."""
    for number in range(30):
        keep = tuple(range(number))
        shown.do(Select((dot(1.0 + number, id=number),), keep, number + 1), PAGE)
        pose(shown, 2.0 + number)
    state = shown.do(Select(keep=tuple(range(30)), total=30), PAGE)
    assert [*state.selected[1]] == [*range(30 - MAX_PAST, 30)]


def test_the_selection_of_a_removed_display_goes(shown: Any) -> None:
    shown.do(Select((dot(1.0),), total=1), PAGE)
    state = shown.do(RemoveDisplay("display1"))
    assert state.selected[1] == {}
    assert told(shown) == {}


def test_what_its_display_does_not_know_any_more_is_said_to_be_gone(shown: Any) -> None:
    shown.source.now = 200 * SECOND
    shown.turn()
    clock = Picks("display2/tick/", "dot", ((1, 0, (200.0, 0.0, 0.0), None),))
    shown.do(Select((clock,), total=1), PAGE)
    shown.clock += 1.0
    shown.do(SetProperty("display2", "enabled", False))
    assert told(shown)["note"] == "It no longer exists."


def test_a_plugin_that_gives_the_wrong_number_of_ids_is_named(bench: Benches) -> None:
    class Wrong(Display):
        def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
            ctx.points("dots", [[0, 0, 0], [1, 0, 0]], (0, 0, 0), 0.1, ids=np.arange(3))

    b = bench(Wrong(), strict=False)
    assert b.ask(Identify(Picks("display1/all/", "dots", ((1, 1, (1.0, 0.0, 0.0), None),)))) == ""
    assert "a node has 2 items, but 3 ids" in b.statuses()["Display"][1]
