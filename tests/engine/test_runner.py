"""Guarantees to displays, shown with displays of a few lines."""

from __future__ import annotations

import gc
import threading
import time
import weakref
from collections.abc import Sequence
from typing import Annotated, Any

import pytest
from bench import Bench, Benches
from dots import POSE, SECOND, FrameDot, PoseDot, T, dots, show_dot

from webviz import (
    Context,
    Display,
    Input,
    Keep,
    Prop,
    Sample,
    Selective,
    Topic,
)
from webviz.api.nodes import Lines, Points
from webviz.api.status import LOADING
from webviz.commands import Reset, SetFixedFrame, SetProperty


class Trail(Display, Selective):
    """A line through all poses that are a metre apart."""

    topic: Annotated[Topic, Input(POSE)] = Topic("/pose")

    def history(self) -> Keep:
        return Keep(0)

    def accept(self, new: Sample, buffered: Sequence[Sample]) -> bool:
        return not buffered or abs(new.pose.position[0] - buffered[-1].pose.position[0]) >= 1.0

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        ctx.strip("trail", [sample.pose.position for sample in samples], (0, 255, 0))


class TwoTopicSum(Display):
    """The sum of what two topics say."""

    topic: Annotated[Topic, Input(POSE)] = Topic("/pose")
    more: Annotated[Topic, Input(POSE)] = Topic("/more")

    def fold(self, name: str, sample: Sample, state: Any) -> Any:
        return (state or 0.0) + sample.message.pose.position.x

    def draw(self, sample: Sample, ctx: Context) -> None:
        ctx.points("sum", [[sample.message, 0, 0]], (0, 0, 255), 0.1)


class BackgroundDot(Display):
    """A dot at the result of a slow computation."""

    value: Annotated[int, Prop()] = 1
    is_silent: bool = False

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        result = ctx.background(("slow", self.value), _compute, self.value)
        if result is not None:
            ctx.points("slow", [[result, 0, 0]], (1, 1, 1), 0.1)
        elif not self.is_silent:
            ctx.warn("Slow", "computing")


GATE = threading.Event()


def _compute(value: int) -> int:
    GATE.wait(60)
    return 10 * value


def test_a_message_is_drawn_with_the_transform_at_its_stamp(b: Bench) -> None:
    b.transform("map", "base", T - SECOND, 0.0)
    b.transform("map", "base", T, 10.0)
    b.pose("/pose", "base", T - SECOND // 2, 1.0)
    b.turn()
    assert dots(b) == [6.0]


def test_a_message_waits_for_its_transform(b: Bench) -> None:
    b.transform("map", "base", T - SECOND, 0.0)
    b.pose("/pose", "base", T, 1.0)
    b.turn()
    assert dots(b) == []
    b.transform("map", "base", T + SECOND, 4.0)
    b.turn()
    assert dots(b) == [3.0]


def test_a_message_that_waits_is_a_state_and_not_an_empty_one(b: Bench) -> None:
    b.transform("map", "base", T - SECOND)
    b.pose("/pose", "base", T, 1.0)
    b.turn()
    assert "Display" not in b.statuses()
    waiting = "Waiting for the transforms at the time of the data."
    assert b.statuses()["Transform"] == ("IDLE", waiting)
    b.transform("map", "base", T + SECOND)
    b.turn()
    assert b.statuses()["Transform"] == ("OK", "Transform OK")


def test_slow_work_without_a_status_is_a_state_and_not_nothing_to_draw(bench: Benches) -> None:
    GATE.clear()
    b = bench(BackgroundDot(name="Slow", is_silent=True))
    b.turn()
    assert b.statuses() == {LOADING: ("IDLE", "Loading.")}
    GATE.set()
    deadline = time.monotonic() + 60
    while not dots(b) and time.monotonic() < deadline:
        b.turn()
    assert b.statuses() == {}


def test_a_newer_message_that_waits_does_not_displace_one_that_is_ready(b: Bench) -> None:
    b.transform("map", "base", T - SECOND)
    b.transform("map", "base", T)
    b.pose("/pose", "base", T, 1.0)
    b.pose("/pose", "base", T + SECOND, 2.0)
    b.turn()
    assert dots(b) == [1.0]


def test_a_new_value_of_a_property_shows_without_a_new_message(b: Bench) -> None:
    show_dot(b)
    b.viewer.enqueue(SetProperty("display1", "size", 0.7))
    b.turn()
    assert [node.size for node in b.nodes(Points)] == [0.7]


def test_a_refused_value_changes_nothing(b: Bench) -> None:
    b.viewer.enqueue(SetProperty("display1", "size", -1))
    b.viewer.enqueue(SetProperty("display1", "nonsense", 1))
    b.viewer.enqueue(SetProperty("display9", "size", 1))
    b.turn()
    assert b.display(PoseDot).size == 0.1


def test_a_new_fixed_frame_moves_all_nodes(bench: Benches) -> None:
    b = bench(PoseDot(name="Dot", count=3))
    b.transform("map", "odom", 0, 100.0, static=True)
    b.transform("odom", "base", T, 1.0)
    b.pose("/pose", "base", T, 1.0)
    b.pose("/pose", "map", T, 5.0)
    b.turn()
    assert dots(b) == [5.0, 102.0]
    upserts = b.scene.upserts
    b.viewer.enqueue(SetFixedFrame("odom"))
    b.turn()
    assert dots(b) == [-95.0, 2.0]
    assert b.scene.upserts > upserts


def test_in_a_new_fixed_frame_data_stay_at_their_stamp_and_followers_follow(bench: Benches) -> None:
    b = bench(PoseDot(name="Dot"), Poster(name="Poster"))
    b.transform("map", "odom", 0, 100.0, static=True)
    b.transform("odom", "base", T, 1.0)
    b.pose("/pose", "base", T, 1.0)
    b.turn()
    assert dots(b) == [101.0, 102.0]
    b.source.now = T + SECOND
    b.transform("odom", "base", b.source.now, 50.0)
    b.turn()
    assert dots(b) == [102.0, 150.0]
    b.viewer.enqueue(SetFixedFrame("odom"))
    b.turn()
    assert dots(b) == [2.0, 50.0]


def test_replaced_nodes_are_freed(b: Bench) -> None:
    b.transform("map", "base", T, static=True)
    gc.collect()
    gc.disable()  # it may come late, and large messages often
    try:
        b.pose("/pose", "base", T, 1.0)
        b.turn()
        points = [weakref.ref(node.xyz) for node in b.nodes(Points)]
        b.pose("/pose", "base", T, 2.0)
        b.turn()
        assert [each() is None for each in points] == [True]
    finally:
        gc.enable()


def test_history_is_bounded_by_count(bench: Benches) -> None:
    b = bench(PoseDot(name="Dot", count=2))
    b.transform("map", "base", T, static=True)
    for x in range(5):
        b.pose("/pose", "base", T, float(x))
    b.turn()
    assert dots(b) == [3.0, 4.0]


def test_history_is_bounded_by_age(bench: Benches) -> None:
    b = bench(PoseDot(name="Dot", count=0, seconds=2.0))
    show_dot(b, 1.0)
    b.source.now += 1 * SECOND
    b.pose("/pose", "base", T, 2.0)
    b.turn()
    assert dots(b) == [1.0, 2.0]
    b.source.now += round(1.5 * SECOND)
    b.turn()
    assert dots(b) == [2.0]


def test_a_display_filters_its_messages(bench: Benches) -> None:
    b = bench(Trail(name="Trail"))
    for n, x in enumerate((0.0, 0.4, 1.2, 1.5, 2.3)):
        b.transform("map", "base", T + n, x)
        b.pose("/pose", "base", T + n)
    b.turn()
    (node,) = b.nodes(Lines)
    assert [round(float(x), 3) for x in node.segments[:, 1, 0]] == [1.2, 2.3]


def test_inputs_can_fold_into_one(bench: Benches) -> None:
    b = bench(TwoTopicSum(name="Sum"))
    b.transform("map", "base", T, static=True)
    for topic, x in (("/pose", 1.0), ("/more", 10.0), ("/pose", 2.0)):
        b.pose(topic, "base", T, x)
    b.turn()
    assert dots(b) == [13.0]


class PositiveSum(TwoTopicSum):
    """The sum of the numbers that are positive; fails on negative ones."""

    def fold(self, name: str, sample: Sample, state: Any) -> Any:
        x = sample.message.pose.position.x
        if x < 0.0:
            raise ValueError("negative")
        return super().fold(name, sample, state) if x else None


def test_messages_that_fold_into_nothing_or_fail_keep_the_drawing(bench: Benches) -> None:
    b = bench(PositiveSum(name="Sum"), strict=False)
    b.transform("map", "base", T, static=True)
    for x in (1.0, 0.0, -1.0):
        b.pose("/pose", "base", T, x)
        b.turn()
        assert dots(b) == [1.0]
    b.pose("/pose", "base", T, 2.0)
    b.turn()
    assert dots(b) == [3.0]


def test_nodes_of_a_frame_without_a_transform_are_hidden_with_an_error(
    bench: Benches,
) -> None:
    b = bench(FrameDot(name="Marker"))
    b.transform("map", "other", T, static=True)
    b.turn()
    level, text = b.statuses()["Transform"]
    assert dots(b) == []
    assert level == "ERROR"
    assert "base" in text
    b.transform("map", "base", T, 3.0)
    b.turn()
    assert dots(b) == [3.0]
    assert b.statuses() == {}


def test_a_disabled_display_hears_nothing_and_draws_nothing_but_forgets_nothing(b: Bench) -> None:
    show_dot(b, 1.0)
    b.viewer.enqueue(SetProperty("display1", "enabled", False))
    b.turn()
    assert (dots(b), "/pose" in b.source.subscriptions, b.statuses()) == ([], False, {})
    b.viewer.enqueue(SetProperty("display1", "enabled", True))
    b.turn()
    assert dots(b) == [1.0]
    assert "/pose" in b.source.subscriptions


def test_nothing_is_drawn_until_a_browser_connects(bench: Benches) -> None:
    b = bench(PoseDot(name="Dot"), Trail(name="Trail"))
    b.scene.watched = False
    upserts = b.scene.upserts
    for n in range(3):
        b.transform("map", "base", T + n, float(n))
        b.pose("/pose", "base", T + n)
        b.turn()
    assert b.scene.upserts == upserts
    b.scene.watched = True
    b.turn()
    assert len(list(b.scene.visible())) == 2


def test_a_crash_becomes_a_status_and_the_rest_goes_on(bench: Benches) -> None:
    b = bench(PoseDot(name="Dot"), Trail(name="Trail"), strict=False)
    show_dot(b, 1.0)
    b.pose("/pose", "base", T, -1.0)
    b.turn()
    level, text = b.statuses(0)["Display"]
    assert (level, text) == ("ERROR", "PoseDot failed: ValueError: negative")
    b.pose("/pose", "base", T, 2.0)
    b.turn()
    assert "Display" not in b.statuses(0)


def test_strict_lets_a_crash_through(b: Bench) -> None:
    b.transform("map", "base", T, static=True)
    b.pose("/pose", "base", T, -1.0)
    with pytest.raises(ValueError, match="negative"):
        b.turn()


def test_slow_work_is_drawn_when_it_is_done_and_stale_work_never(bench: Benches) -> None:
    GATE.clear()
    b = bench(BackgroundDot(name="Slow"))
    b.turn()
    assert b.statuses()["Slow"] == ("WARN", "computing")
    b.viewer.enqueue(SetProperty("display1", "value", 2))
    b.turn()
    GATE.set()
    deadline = time.monotonic() + 60
    while not dots(b) and time.monotonic() < deadline:
        b.turn()
    assert dots(b) == [20.0]


def test_a_reset_and_a_jump_back_of_time_clear_displays(b: Bench) -> None:
    for command in (Reset(), None):
        show_dot(b, 1.0)
        assert dots(b) == [1.0]
        if command:
            b.viewer.enqueue(command)
        else:
            b.source.now -= 5 * SECOND
        b.turn()
        assert dots(b) == []


def test_undecodable_bytes_are_a_status(b: Bench) -> None:
    from webviz.sources import Raw

    show_dot(b, 1.0)
    for junk in (b"", b"\x00\x01\x00\x00abc", b"\xff" * 40):
        b.source.inbox.put("/pose", Raw(junk, T))
        b.source.inbox.put("/tf", Raw(junk, T))
        level, text = b.statuses()["Message"]
        assert level == "ERROR"
        assert "PoseStamped" in text
        assert "/tf" in b.states[-1].statuses
    b.pose("/pose", "base", T, 2.0)
    b.transform("map", "base", T)
    b.turn()
    assert dots(b) == [2.0]
    assert "Message" not in b.statuses()
    assert "/tf" not in b.states[-1].statuses


def test_the_same_latched_message_again_is_ignored(b: Bench) -> None:
    from webviz.sources import Offer, Publisher

    publisher = Publisher("/test", POSE, "reliable", "transient_local")
    b.source.topics["/pose"] = Offer((publisher,), ("reliable", "transient_local"))
    b.transform("map", "base", T, static=True)
    for _ in range(3):
        b.pose("/pose", "base", T, 1.0)
    assert b.statuses()["Topic"][1].startswith("1 message,")


class WithUpdates(PoseDot):
    """A dot that further messages may move."""

    updates: Annotated[Topic, Input(POSE, suffix="_updates", optional=True)] = Topic()


def test_an_optional_input_follows_the_first_ones_topic_and_may_be_silent(bench: Benches) -> None:
    b = bench(WithUpdates(name="Dot", topic=Topic("/goal")))
    assert set(b.source.subscriptions) >= {"/goal", "/goal_updates"}
    b.transform("map", "base", T, static=True)
    b.pose("/goal", "base", T, 1.0)
    assert {level for level, _ in b.statuses().values()} == {"OK"}
    b.viewer.enqueue(SetProperty("display1", "topic.name", "/other"))
    b.turn()
    assert {"/other", "/other_updates"} <= set(b.source.subscriptions)


class Poster(PoseDot):
    """A dot that stays with its frame, whenever it was published."""

    def waits(self, name: str) -> bool:
        return False

    def draw(self, sample: Sample, ctx: Context) -> None:
        ctx.follow(sample.frame, when="now").points("dot", [[0, 0, 0]], (255, 0, 0), 0.1)


def test_a_display_that_follows_a_frame_needs_no_transform_at_the_stamp(bench: Benches) -> None:
    b = bench(Poster(name="Poster"))
    b.pose("/pose", "map", T - 3600 * SECOND)
    b.transform("odom", "map", T, 3.0)
    b.turn()
    b.viewer.enqueue(SetFixedFrame("odom"))
    b.turn()
    assert dots(b) == [3.0]


class DrawCounter(Display):
    """Counts how often it was drawn."""

    topic: Annotated[Topic, Input(POSE)] = Topic("/pose")

    def new_state(self) -> list[int]:
        return []

    def draw(self, sample: Sample, ctx: Context) -> None:
        ctx.state.append(sample.number)
        ctx.ok("Drawn", f"{len(ctx.state)} times")


def test_state_lasts_from_call_to_call_until_a_reset(bench: Benches) -> None:
    b = bench(DrawCounter(name="Counter"))
    b.transform("map", "base", T, static=True)
    for _ in range(2):
        b.pose("/pose", "base", T)
        b.turn()
    assert b.statuses()["Drawn"] == ("OK", "2 times")
    b.do(Reset())
    show_dot(b)
    assert b.statuses()["Drawn"] == ("OK", "1 times")
