"""Selections of browsers: found in what they show, and asked of the display."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Annotated, Any

import numpy as np
import pytest
from bench import Bench, Benches

from webviz import Context, Details, Display, Hit, Input, Quantity, Sample, Topic
from webviz.commands import Identify, InspectSelections, RemoveDisplay, Select, SetProperty
from webviz.engine.commands import NodePicks, Sender
from webviz.features.selection import MAX_PAST, MAX_SELECTED

SECOND = 1_000_000_000
PAGE, OTHER = Sender(1), Sender(2)
DOTS = "display1/topic.0/"


class DotPair(Display):
    """A red and a green point for each pose, at its x."""

    topic: Annotated[Topic, Input("geometry_msgs/msg/PoseStamped")] = Topic("/pose")
    requests: int = 0

    def draw(self, sample: Sample, ctx: Context) -> None:
        x = sample.message.pose.position.x
        ctx.points("dots", [[x, 0, 0], [x, 1, 0]], [(255, 0, 0), (0, 255, 0)], 0.1)

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        self.requests += 1
        x = hit.sample.message.pose.position.x
        now = f"{ctx.frames.now_ns}"
        return Details(f"Dot {hit.id}", {"x": x, "Way": Quantity(x / 2, "km"), "Now": now})


class Moving(Display):
    """A point that is asked where it is."""

    def tick(self, ctx: Context) -> None:
        ctx.points("dot", [[ctx.frames.now_ns / 1e9, 0, 0]], (0, 0, 0), 0.1)

    def inspect(self, hit: Hit, ctx: Context) -> Details | None:
        return Details("Clock", {"Time": ctx.frames.now_ns // SECOND}) if self.enabled else None


def dot(x: float, number: int = 1, id: int = 5) -> NodePicks:
    """One of the two dots as a browser has it."""
    color = [(255, 0, 0), (0, 255, 0)][number]
    return NodePicks(DOTS, "dots", ((id, number, (x, float(number), 0.0), color),))


@pytest.fixture
def dots(bench: Benches) -> Bench:
    """A viewer with a pose at x = 1, and page 1 looking at its selection."""
    b = bench(DotPair(name="Pair"), Moving(name="Clock"))
    b.source.now = 100 * SECOND
    b.transform("map", "base", 0, static=True)
    b.do(InspectSelections(frozenset({1, 2}), frozenset({1}), is_picking=True))
    pose(b, 1.0)
    return b


def pose(b: Bench, x: float) -> None:
    b.source.now += SECOND // 10
    b.clock += 0.1
    b.pose("/pose", "base", b.source.now, x)
    b.turn()


def selection(b: Bench, browser: int = 1) -> Any:
    """Return what the panel shows of the only selected item."""
    b.turn(keep_up=True)
    things = {key: each for key, each in b.states[-1].selections[browser].items() if key != "/info"}
    return things.popitem()[1] if len(things) == 1 else things


def test_details_of_a_selection_come_from_its_display_with_frame_and_stamp(dots: Bench) -> None:
    state = dots.do(Select((dot(1.0),), total=1), PAGE)
    thing = selection(dots)
    assert (thing["display"], thing["name"], thing["title"]) == ("display1", "Pair", "Dot 1")
    values = thing["tree"]["fields"]
    assert (values["x"], values["Position in map"]) == ("1", "1.0000, 1.0000, 0.0000 m")
    assert (values["Frame"], values["Stamp"]) == ("base", "100.100000 s")
    assert state.selected == {1: {5: ("display1", False)}}


def test_a_click_on_a_replaced_frame_selects_from_its_snapshot(dots: Bench) -> None:
    for x in (2.0, 3.0):
        pose(dots, x)
    dots.do(Select((dot(2.0),), total=1), PAGE)
    thing = selection(dots)
    assert thing["tree"]["fields"]["x"] == "2"
    assert thing["note"].startswith("A newer message has replaced this one")


@pytest.mark.parametrize(
    "picks",
    [
        dot(7.0),
        NodePicks(DOTS, "dots", ((5, 1, (1.0, 1.0, 0.0), (255, 0, 0)),)),
        NodePicks(DOTS, "dots", ((5, 1, (1.0, 1.0, 0.0), None),)),
        NodePicks(DOTS, "dots", ((5, 2, (1.0, 1.0, 0.0), (0, 255, 0)),)),
        NodePicks(DOTS, "dots", ((5, 10**18, (1.0, 1.0, 0.0), (0, 255, 0)),)),
        NodePicks(DOTS, "dots", ((5, 10**30, (1.0, 1.0, 0.0), (0, 255, 0)),)),
        NodePicks(DOTS, "dots", ((5, -1, (1.0, 1.0, 0.0), (0, 255, 0)),)),
        NodePicks(DOTS, "dots", ((5, None, (1.0, 1.0, 0.0), (0, 255, 0)),)),
        NodePicks(DOTS, "dots", ((5, 1, (math.nan, math.nan, math.nan), (0, 255, 0)),)),
        NodePicks(DOTS, "dots", ((5, 1, (math.inf, 1e308, -1e308), (0, 255, 0)),)),
        NodePicks(DOTS, "other", dot(1.0).items),
        NodePicks("display1/../topic.0/", "dots", dot(1.0).items),
        NodePicks("display1", "dots", dot(1.0).items),
        NodePicks("display9/topic.0/", "dots", dot(1.0).items),
        NodePicks("", "", dot(1.0).items),
        NodePicks("/" * 1000, "\0", dot(1.0).items),
    ],
)
def test_picks_without_a_snapshot_are_refused(dots: Bench, picks: NodePicks) -> None:
    before = dots.states[-1].selected
    answer = dots.viewer.enqueue(Select((picks,), total=1), PAGE)
    dots.until_done(answer)
    assert str(answer.exception(0)) == "It has been replaced since the click. Click again."
    assert dots.ask(Identify(picks)) == ""
    assert dots.states[-1].selected == before


def test_one_line_identifies_the_item_under_the_pointer(dots: Bench) -> None:
    assert dots.ask(Identify(dot(1.0, 0))) == "Pair · Dot 0 · x 1"


def test_snapshots_are_kept_only_while_a_selection_is_possible(dots: Bench) -> None:
    pose(dots, 2.0)
    dots.do(InspectSelections(frozenset({1}), frozenset({1})))
    assert dots.ask(Identify(dot(1.0))) == ""
    assert dots.ask(Identify(dot(2.0))) != ""


def test_values_stay_up_to_date_while_they_are_looked_at_and_only_then(dots: Bench) -> None:
    dots.source.now = 200 * SECOND
    dots.turn()
    clock = NodePicks("display2/tick/", "dot", ((1, 0, (200.0, 0.0, 0.0), None),))
    dots.do(Select((clock, dot(1.0)), total=2), PAGE)
    dots.source.now, dots.clock = 300 * SECOND, dots.clock + 1.0
    assert {thing["tree"]["fields"].get("Time") for thing in selection(dots).values()} == {
        "300",
        None,
    }
    display = dots.states[-1].rows[0].display
    dots.do(InspectSelections(frozenset({1}), frozenset()))
    assert isinstance(display, DotPair)
    requests = display.requests
    dots.clock += 1.0
    assert selection(dots) == {}
    assert display.requests == requests


def test_browsers_select_each_for_themselves_until_they_leave(dots: Bench) -> None:
    dots.do(Select((dot(1.0),), total=1), PAGE)
    dots.do(Select((dot(1.0, 0, id=9),), total=1), OTHER)
    assert {browser: [*things] for browser, things in dots.states[-1].selected.items()} == {
        1: [5],
        2: [9],
    }
    state = dots.do(InspectSelections(frozenset({2}), frozenset()))
    assert [*state.selected] == [2]


def test_more_is_added_and_some_is_kept(dots: Bench) -> None:
    dots.do(Select((dot(1.0),), total=1), PAGE)
    state = dots.do(Select((dot(1.0, 0, id=6),), keep=(5, 77), total=2), PAGE)
    assert [*state.selected[1]] == [5, 6]
    assert [*dots.do(Select(keep=(6,), total=1), PAGE).selected[1]] == [6]
    assert dots.do(Select(), PAGE).selected == {}


def test_a_selection_has_a_limit(dots: Bench) -> None:
    items = tuple((id, 1, (1.0, 1.0, 0.0), (0, 255, 0)) for id in range(MAX_SELECTED + 1))
    answer = dots.viewer.enqueue(Select((NodePicks(DOTS, "dots", items),)), PAGE)
    dots.until_done(answer)
    assert str(answer.exception(0)) == "Select at most 1000 things at once."
    dots.do(Select((NodePicks(DOTS, "dots", items[:-1]),), total=50_000), PAGE)
    info = dots.states[-1].selections[1]["/info"]
    assert (info["count"], info["total"]) == (1000, 50_000)


def test_statistics_are_of_the_numbers_of_each_display(dots: Bench) -> None:
    first, second = (NodePicks(DOTS, "dots", dot(1.0, number, number).items) for number in (0, 1))
    dots.do(Select((first,), total=1), PAGE)
    assert "displays" not in dots.states[-1].selections[1]["/info"]
    pose(dots, 4.0)
    third = dot(4.0, 1, 2)
    dots.do(Select((second, third), keep=(0,), total=3), PAGE)
    (display,) = dots.states[-1].selections[1]["/info"]["displays"]
    assert (display["name"], display["count"]) == ("Pair", 3)
    assert [tuple(each.values()) for each in display["ranges"]] == [
        ("x in map", "m", 1.0, 4.0, 2.0),
        ("y in map", "m", 0.0, 1.0, pytest.approx(2 / 3)),
        ("z in map", "m", 0.0, 0.0, 0.0),
        ("x", "", 1.0, 4.0, 2.0),
        ("Way", "km", 0.5, 2.0, 1.0),
    ]


def test_only_so_many_replaced_messages_are_held(dots: Bench) -> None:
    """A program could otherwise hold every cloud that ever came."""
    for number in range(30):
        keep = tuple(range(number))
        dots.do(Select((dot(1.0 + number, id=number),), keep, number + 1), PAGE)
        pose(dots, 2.0 + number)
    state = dots.do(Select(keep=tuple(range(30)), total=30), PAGE)
    assert [*state.selected[1]] == [*range(30 - MAX_PAST, 30)]


def test_the_selection_of_a_removed_display_goes(dots: Bench) -> None:
    dots.do(Select((dot(1.0),), total=1), PAGE)
    state = dots.do(RemoveDisplay("display1"))
    assert state.selected[1] == {}
    assert selection(dots) == {}


def test_a_selected_item_of_a_disabled_display_no_longer_exists(dots: Bench) -> None:
    dots.source.now = 200 * SECOND
    dots.turn()
    clock = NodePicks("display2/tick/", "dot", ((1, 0, (200.0, 0.0, 0.0), None),))
    dots.do(Select((clock,), total=1), PAGE)
    dots.clock += 1.0
    dots.do(SetProperty("display2", "enabled", False))
    assert selection(dots)["note"] == "It no longer exists."


def test_a_plugin_that_gives_the_wrong_number_of_ids_is_named(bench: Benches) -> None:
    class Wrong(Display):
        def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
            ctx.points("dots", [[0, 0, 0], [1, 0, 0]], (0, 0, 0), 0.1, ids=np.arange(3))

    b = bench(Wrong(), strict=False)
    assert (
        b.ask(Identify(NodePicks("display1/all/", "dots", ((1, 1, (1.0, 0.0, 0.0), None),)))) == ""
    )
    assert "a node has 2 items, but 3 ids" in b.statuses()["Display"][1]
