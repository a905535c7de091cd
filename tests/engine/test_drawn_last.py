"""Pictures kept from the last drawing, and drawing in a worker while properties are set."""

from __future__ import annotations

import threading
import time
from typing import Annotated, Any, ClassVar

import pytest
from bench import Benches

from webviz import Context, Display, Input, Prop, Sample, Topic
from webviz.commands import SetFixedFrame, SetProperty

SECOND = 1_000_000_000
T = 100 * SECOND
POSE = "geometry_msgs/msg/PoseStamped"


class Link(Display):
    """A dot at a frame, which stays if its transform is lost."""

    def draw_all(self, samples: Any, ctx: Context) -> None:
        link = ctx.follow("base", keep_last=True)
        link.points("dot", [[0, 0, 0]], (255, 0, 0), 0.1)


@pytest.mark.parametrize("other", ["elsewhere", "somewhere"])  # before and after "map"
def test_what_stays_at_its_last_pose_does_so_in_one_fixed_frame_only(
    bench: Benches, other: str
) -> None:
    b = bench(Link(name="Link"))
    b.transform("map", "base", T, x=3.0)
    b.transform(other, "odd", T)
    b.turn()
    assert [pose.position[0] for _, pose, _ in b.scene.visible()] == [3.0]
    b.viewer.buffer.clear()
    b.turn()
    assert [pose.position[0] for _, pose, _ in b.scene.visible()] == [3.0]
    b.do(SetFixedFrame(other))
    assert list(b.scene.visible()) == []


class Slow(Display):
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
    drawn: list[int] = []
    b = bench(Slow(name="Slow"))
    b.transform("map", "base", T, static=True)
    b.pose("/pose", "base", T)
    b.turn()
    assert Slow.begun.wait(60.0)
    b.viewer.enqueue(SetProperty("display1", "count", 5))
    b.turn()
    Slow.may_end.set()
    deadline = time.monotonic() + 60.0
    while not drawn or drawn[-1] != 5:
        assert time.monotonic() < deadline
        b.turn()
        drawn += [len(node.xyz) for _, _, node in b.scene.visible()]
        time.sleep(0.005)
    assert drawn[0] == 1
