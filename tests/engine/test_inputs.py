"""Displays with several inputs: each sample says whose it is, and those of one stamp meet."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any

import pytest
from bench import Bench, Benches
from dots import POSE, SECOND, T

from webviz import Context, Display, Input, Keep, Sample, Sync, Topic
from webviz.api.display import inputs_of
from webviz.api.nodes import Lines, Points
from webviz.commands import Reset, SetFixedFrame
from webviz.engine.pipeline import synchronizer


class TwoInputs(Display):
    left: Annotated[Topic, Input(POSE)] = Topic("/left")
    right: Annotated[Topic, Input(POSE)] = Topic("/right")
    count: int = 1

    def history(self) -> Keep:
        return Keep(self.count)


def mark(sample: Sample, ctx: Context, key: str) -> None:
    ctx.points(key, [[sample.message.pose.position.x, 0, 0]], (255, 0, 0), 0.1)


class DotPerInput(TwoInputs):
    """A dot for each of two poses."""

    def draw(self, sample: Sample, ctx: Context) -> None:
        mark(sample, ctx, sample.input)


class DotsAtOnce(TwoInputs):
    """The same dots, drawn by one call."""

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        for index, sample in enumerate(samples):
            mark(sample, ctx, f"{sample.input} {index}")


def dots(bench: Bench) -> list[tuple[str, float]]:
    """Key and x of every visible dot."""
    return sorted(
        (key.split()[0], pose.position[0] + float(node.xyz[0][0]))
        for key, pose, node in bench.scene.visible()
        if isinstance(node, Points)
    )


@pytest.mark.parametrize("display", [DotPerInput, DotsAtOnce])
def test_each_of_two_inputs_has_its_newest_message_drawn(
    bench: Benches, display: type[TwoInputs]
) -> None:
    b = bench(display(name="Two"))
    b.transform("map", "base", T, static=True)
    for x in (1.0, 2.0):
        b.pose("/left", "base", T, x)
        b.pose("/right", "base", T, 10 * x)
    b.turn()
    assert dots(b) == [("left", 2.0), ("right", 20.0)]
    b.pose("/right", "base", T, 30.0)
    b.turn()
    assert dots(b) == [("left", 2.0), ("right", 30.0)]


class PoseReporter(TwoInputs):
    """Reports what it thinks of each pose."""

    def draw(self, sample: Sample, ctx: Context) -> None:
        mark(sample, ctx, "dot")
        say = ctx.warn if sample.message.pose.position.x < 0 else ctx.ok
        say("Pose", f"{sample.input} is at {sample.message.pose.position.x:g}")


@pytest.mark.parametrize("culprit", ["left", "right"])
def test_a_warning_about_one_input_is_not_hidden_by_the_other(bench: Benches, culprit: str) -> None:
    b = bench(PoseReporter(name="Poses"))
    b.transform("map", "base", T, static=True)
    for name in ("left", "right"):
        b.pose(f"/{name}", "base", T, -1.0 if name == culprit else 1.0)
    b.turn()
    assert b.statuses()["Pose"] == ("WARN", f"{culprit} is at -1")


class Pair(TwoInputs):
    """A line between two poses of one stamp."""

    sync = Sync("left", "right")

    def draw(self, sample: Sample, ctx: Context) -> None:
        ends = [sample.message, sample.synced["right"].message]
        ctx.strip("line", [[end.pose.position.x, 0, 0] for end in ends], (0, 255, 0))


class LoosePair(Pair):
    """A line between two poses of almost the same stamp."""

    sync = Sync("left", "right", slop=0.1)


def lines(bench: Bench) -> list[list[float]]:
    """The x of the ends of every visible line."""
    return [node.segments[0, :, 0].tolist() for node in bench.nodes(Lines)]


def test_messages_of_one_stamp_are_drawn_together(bench: Benches) -> None:
    b = bench(Pair(name="Pair"))
    b.transform("map", "base", T, static=True)
    b.pose("/left", "base", T, 1.0)
    b.turn()
    assert lines(b) == []
    b.pose("/left", "base", T + SECOND, 2.0)
    b.pose("/right", "base", T, 10.0)
    b.turn()
    assert lines(b) == [[1.0, 10.0]]
    b.pose("/right", "base", T + SECOND, 20.0)
    b.turn()
    assert lines(b) == [[2.0, 20.0]]
    assert b.statuses()["Sync"] == ("OK", "2 sets of 2 messages with equal stamps.")


def test_a_slop_lets_messages_of_nearby_stamps_meet(bench: Benches) -> None:
    b = bench(LoosePair(name="Pair"))
    b.transform("map", "base", T, static=True)
    b.pose("/left", "base", T, 1.0)
    b.pose("/left", "base", T + SECOND, 2.0)
    b.pose("/right", "base", T + SECOND + SECOND // 20, 20.0)
    b.turn()
    assert lines(b) == [[2.0, 20.0]]
    text = "1 set of 2 messages with stamps within 0.1 s; 1 unmatched message dropped."
    assert b.statuses()["Sync"] == ("OK", text)


def test_unmatched_messages_are_bounded_in_bytes(
    bench: Benches, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(synchronizer, "MAX_BYTES", 150)
    b = bench(Pair(name="Pair"))
    b.transform("map", "base", T, static=True)
    for number in range(3):
        b.pose("/left", "base", T + number * SECOND, float(number))
    b.turn()
    for number in range(3):
        b.pose("/right", "base", T + number * SECOND, 10.0 * number)
    b.turn()
    assert lines(b) == [[2.0, 20.0]]
    text = "1 set of 2 messages with equal stamps; 4 unmatched messages dropped."
    assert b.statuses()["Sync"] == ("OK", text)


@pytest.mark.parametrize(
    ("display", "stamp_ns", "text"),
    [
        (
            Pair,
            None,
            "Waiting for a PoseStamped on /right with the stamp of the PoseStamped on /left, "
            "100.000 s. None has arrived. Start its publisher or choose another topic.",
        ),
        (
            Pair,
            T - 500,
            "Waiting for a PoseStamped on /right with the stamp of the PoseStamped on /left, "
            "100.000 s. The nearest is 500 ns earlier. Use equal stamps in their publishers.",
        ),
        (
            LoosePair,
            T + 2 * SECOND,
            "Waiting for a PoseStamped on /left within 0.1 s of the PoseStamped on /right, "
            "102.000 s. The nearest is 2.0 s earlier. Synchronise the clocks of their publishers.",
        ),
    ],
)
def test_a_status_names_the_input_the_sync_waits_for(
    bench: Benches, display: type[Pair], stamp_ns: int | None, text: str
) -> None:
    b = bench(display(name="Pair"))
    b.transform("map", "base", T, static=True)
    b.pose("/left", "base", T)
    if stamp_ns is not None:
        b.pose("/right", "base", stamp_ns)
    b.turn()
    assert "Sync" not in b.statuses()
    b.clock += 1.1
    assert b.statuses()["Sync"] == ("WARN", text)


def test_a_set_that_waits_for_a_transform_is_not_blamed_on_stamps(bench: Benches) -> None:
    b = bench(Pair(name="Pair"))
    b.transform("map", "base", T, static=True)
    b.pose("/left", "base", T)
    b.pose("/right", "lost", T)
    b.turn()
    b.clock += 1.1
    statuses = b.statuses()
    assert "Sync" not in statuses
    assert statuses["Transform (right)"][0] == "ERROR"


def test_a_reset_drops_unmatched_messages(bench: Benches) -> None:
    b = bench(Pair(name="Pair"))
    b.transform("map", "base", T, static=True)
    b.pose("/left", "base", T)
    b.turn()
    b.do(Reset())
    b.pose("/right", "base", T)
    b.turn()
    assert lines(b) == []


class DotsWithHint(TwoInputs):
    """A dot for each pose, named with its hint if there is one."""

    hint: Annotated[Topic, Input(POSE, optional=True)] = Topic("/hint")
    sync = Sync("left", "hint")

    def draw(self, sample: Sample, ctx: Context) -> None:
        mark(sample, ctx, " ".join([sample.input, *sample.synced]))


def test_an_optional_input_joins_a_sync_once_it_has_a_message(bench: Benches) -> None:
    b = bench(DotsWithHint(name="Hint"))
    b.transform("map", "base", T, static=True)
    b.pose("/left", "base", T, 1.0)
    b.pose("/right", "base", T, 3.0)
    b.turn()
    assert dots(b) == [("left", 1.0), ("right", 3.0)]
    b.pose("/left", "base", T + SECOND, 2.0)
    b.pose("/hint", "base", T + SECOND, 0.0)
    b.turn()
    assert sorted(key for key, *_ in b.scene.visible()) == ["left hint", "right"]


class LineOfPoses(TwoInputs):
    """A line between two poses, each in its own frame."""

    sync = Sync("left", "right")

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        for sample in samples:
            ends = [sample.pose, sample.synced["right"].pose]
            ctx.strip("ends", [end.position for end in ends], (0, 255, 0))


def test_all_of_a_set_moves_into_a_new_fixed_frame(bench: Benches) -> None:
    b = bench(LineOfPoses(name="Line"))
    b.transform("map", "a", T, 1.0, static=True)
    b.transform("map", "b", T, 5.0, static=True)
    b.pose("/left", "a", T)
    b.pose("/right", "b", T)
    b.turn()
    assert lines(b) == [[1.0, 5.0]]
    b.do(SetFixedFrame("a"))
    assert lines(b) == [[0.0, 4.0]]


def test_a_sync_of_an_unknown_input_is_refused_with_its_name() -> None:
    class Wrong(TwoInputs):
        sync = Sync("left", "count")

    with pytest.raises(TypeError, match=r"Wrong.sync: 'count' is not an input of the display"):
        inputs_of(Wrong)


@pytest.mark.parametrize(
    ("inputs", "options"),
    [
        (["a"], {}),
        (["a", "a"], {}),
        (["a", "b", "a"], {}),
        (["a", "b"], {"slop": -1}),
        (["a", "b"], {"queue_size": 0}),
    ],
)
def test_a_sync_that_could_match_nothing_is_refused(
    inputs: list[str], options: dict[str, Any]
) -> None:
    with pytest.raises(ValueError, match="a Sync needs"):
        Sync(*inputs, **options)
