"""Pictures kept from the last drawing, and drawing in a worker while properties are set."""

from __future__ import annotations

import threading
import time
from typing import Annotated, ClassVar

import pytest
from bench import Benches
from dots import POSE, FrameDot, T, dots, show_dot

from webviz import Context, Display, Input, Prop, Sample, Topic
from webviz.api.nodes import Points
from webviz.commands import SetFixedFrame, SetProperty


@pytest.mark.parametrize("other", ["elsewhere", "somewhere"])  # before and after "map"
def test_a_last_pose_is_kept_in_one_fixed_frame_only(bench: Benches, other: str) -> None:
    b = bench(FrameDot(name="Dot", keeps_last=True))
    b.transform("map", "base", T, x=3.0)
    b.transform(other, "odd", T)
    b.turn()
    assert dots(b) == [3.0]
    b.viewer.buffer.clear()
    b.turn()
    assert dots(b) == [3.0]
    b.do(SetFixedFrame(other))
    assert list(b.scene.visible()) == []


class GatedDots(Display):
    """Draws a number of points, once it is allowed to."""

    is_threaded = True
    slow_bytes = 0
    begun: ClassVar[threading.Event] = threading.Event()
    may_end: ClassVar[threading.Event] = threading.Event()

    topic: Annotated[Topic, Input(POSE)] = Topic("/pose")
    count: Annotated[int, Prop(ge=0)] = 1

    def draw(self, sample: Sample, ctx: Context) -> None:
        self.begun.set()
        assert self.may_end.wait(60.0)
        ctx.points("dots", [[0, 0, 0]] * self.count, (255, 0, 0), 0.1)


def test_a_worker_draws_with_the_properties_of_its_start(bench: Benches) -> None:
    counts: list[int] = []
    b = bench(GatedDots(name="Dots"))
    show_dot(b)
    assert GatedDots.begun.wait(60.0)
    b.viewer.enqueue(SetProperty("display1", "count", 5))
    b.turn()
    GatedDots.may_end.set()
    deadline = time.monotonic() + 60.0
    while not counts or counts[-1] != 5:
        assert time.monotonic() < deadline
        b.turn()
        counts += [len(node.xyz) for node in b.nodes(Points)]
        time.sleep(0.005)
    assert counts[0] == 1
