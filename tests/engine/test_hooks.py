"""Hooks of displays besides drawing."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any

from webviz import Context, Display, Input, Sample, Topic
from webviz.commands import SetFixedFrame, SetProperty

SECOND = 1_000_000_000
T = 100 * SECOND


class Chooser(Display):
    """A dot for what a topic says, or for nothing."""

    topic: Annotated[Topic, Input("geometry_msgs/msg/PoseStamped")] = Topic("/pose")
    by_topic: bool = True

    def listens(self, name: str) -> bool:
        return self.by_topic

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        ctx.points("dots", [sample.pose.position for sample in samples], (0, 0, 0), 0.1)


def test_an_input_without_a_meaning_is_neither_subscribed_nor_complained_of(bench: Any) -> None:
    at = bench(Chooser())
    assert "/pose" in at.source.wanted
    assert "Topic" in at.statuses()
    at.viewer.enqueue(SetProperty("display1", "by_topic", False))
    at.turn()
    assert "/pose" not in at.source.wanted
    assert "Topic" not in at.statuses()


class Census(Display):
    """A dot for each frame of two that has a pose."""

    drawn: int = 0

    def depends(self, ctx: Context) -> object:
        return [ctx.frames.latest(frame) is not None for frame in ("a", "b")]

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        self.drawn += 1
        known = sum(ctx.frames.latest(frame) is not None for frame in ("a", "b"))
        ctx.points("dots", [[0, 0, 0]] * known, (0, 0, 0), 0.1)


def test_all_is_drawn_anew_when_what_a_display_depends_on_changes_and_only_then(
    bench: Any,
) -> None:
    census = Census()
    at = bench(census)
    times = []
    for number in range(4):
        at.source.now += SECOND
        at.transform("map", "ab"[number // 2], at.source.now)
        at.turn()
        times.append(census.drawn)
    assert times == [times[0], times[0], times[0] + 1, times[0] + 1]
    (_, _, node) = next(at.scene.visible())
    assert len(node.xyz) == 2


class Ticking(Display):
    """A dot on a frame, moved once a second."""

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        ctx.follow("base", interval_s=1.0).points("dot", [[0, 0, 0]], (255, 255, 255), 0.1)


def test_a_group_with_an_interval_moves_no_more_often_but_at_once_in_a_new_fixed_frame(
    bench: Any,
) -> None:
    at = bench(Ticking())
    at.transform("odom", "map", T, static=True)
    observed = []
    for number in range(1, 6):
        at.transform("map", "base", at.source.now, float(number))
        at.turn()
        ((_, pose, _),) = at.scene.visible()
        observed.append(pose.position[0])
        at.source.now += SECOND * 2 // 5
    assert observed == [1.0, 1.0, 1.0, 4.0, 4.0]
    at.viewer.enqueue(SetFixedFrame("odom"))
    at.turn()
    ((_, pose, _),) = at.scene.visible()
    assert pose.position[0] == 5.0
