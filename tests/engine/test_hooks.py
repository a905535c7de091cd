"""Hooks of displays besides drawing."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

from bench import Benches
from dots import POSE, SECOND, FrameDot, T, dots

from webviz import Context, Display, Input, Sample, Topic
from webviz.api.nodes import Points
from webviz.commands import SetFixedFrame, SetProperty


class Chooser(Display):
    """A dot for what a topic says, or for nothing."""

    topic: Annotated[Topic, Input(POSE)] = Topic("/pose")
    by_topic: bool = True

    def listens(self, name: str) -> bool:
        return self.by_topic

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        ctx.points("dots", [sample.pose.position for sample in samples], (0, 0, 0), 0.1)


def test_an_input_without_a_meaning_is_neither_subscribed_nor_complained_of(bench: Benches) -> None:
    at = bench(Chooser())
    assert "/pose" in at.source.subscriptions
    assert "Topic" in at.statuses()
    at.viewer.enqueue(SetProperty("display1", "by_topic", False))
    at.turn()
    assert "/pose" not in at.source.subscriptions
    assert "Topic" not in at.statuses()


class Census(Display):
    """A dot for each frame of two that has a pose."""

    draws: int = 0

    def depends(self, ctx: Context) -> object:
        return [ctx.frames.latest(frame) is not None for frame in ("a", "b")]

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        self.draws += 1
        count = sum(ctx.frames.latest(frame) is not None for frame in ("a", "b"))
        ctx.points("dots", [[0, 0, 0]] * count, (0, 0, 0), 0.1)


def test_a_display_is_redrawn_only_when_its_dependencies_change(
    bench: Benches,
) -> None:
    census = Census()
    at = bench(census)
    times = []
    for number in range(4):
        at.source.now += SECOND
        at.transform("map", "ab"[number // 2], at.source.now)
        at.turn()
        times.append(census.draws)
    assert times == [times[0], times[0], times[0] + 1, times[0] + 1]
    (node,) = at.nodes(Points)
    assert len(node.xyz) == 2


def test_a_group_with_an_interval_moves_no_more_often_but_at_once_in_a_new_fixed_frame(
    bench: Benches,
) -> None:
    at = bench(FrameDot(interval_s=1.0))
    at.transform("odom", "map", T, static=True)
    observed = []
    for number in range(1, 6):
        at.transform("map", "base", at.source.now, float(number))
        at.turn()
        observed += dots(at)
        at.source.now += SECOND * 2 // 5
    assert observed == [1.0, 1.0, 1.0, 4.0, 4.0]
    at.viewer.enqueue(SetFixedFrame("odom"))
    at.turn()
    assert dots(at) == [5.0]
