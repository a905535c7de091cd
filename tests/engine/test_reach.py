"""Transforms that compose to what cannot be drawn: too far away, infinite or not a number."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Annotated

import pytest
from bench import Bench, Benches
from dots import SECOND, T

from webviz import Context, Display, Input, Pose, Sample, Topic
from webviz.api.nodes import Axes
from webviz.data.transforms.geometry import REACH_M
from webviz.engine.pipeline.scene import NoCameras
from webviz_displays.tf import TF

MANY = 100
"""Frames that are computed as arrays."""


class Marks(Display):
    """A dot at each message, and one that follows a frame."""

    topic: Annotated[Topic, Input("geometry_msgs/msg/PoseStamped")] = Topic("/pose")
    frame: str = "b"
    offset: float = 0.0

    def draw(self, sample: Sample, ctx: Context) -> None:
        ctx.points("sample", [[0, 0, 0]], (0, 0, 0), 0.1)

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        offset = Pose((self.offset, 0.0, 0.0))
        ctx.follow(self.frame, offset=offset).points("follower", [[0, 0, 0]], (0, 0, 0), 0.1)


class FollowingCamera(NoCameras):
    """A camera that follows a frame."""

    def __init__(self, frame: str) -> None:
        self._frame = frame

    def target_frames(self) -> set[str]:
        return {self._frame}


def finite(b: Bench) -> bool:
    """Return whether all poses in the scene are."""
    return all(math.isfinite(sum((*p.position, *p.wxyz))) for p in b.scene.poses.values())


@pytest.mark.parametrize("far", [1e308, math.inf, REACH_M])
@pytest.mark.parametrize("others", [0, MANY], ids=["few", "many"])
def test_poses_out_of_reach_are_not_drawn_and_the_link_is_named(
    bench: Benches, far: float, others: int
) -> None:
    b = bench(Marks(name="Marks"), TF(name="TF"))
    for _ in range(5):
        b.source.now += SECOND // 2
        b.clock += 0.5
        b.transform("map", "a", b.source.now, far)
        b.transform("a", "b", b.source.now, far)
        for number in range(others):
            b.transform("map", f"frame{number}", b.source.now, 1.0)
        b.pose("/pose", "b", b.source.now)
        b.turn()
    assert finite(b)
    assert [key for key, *_ in b.scene.visible("display1")] == []
    level, text = b.statuses(0)["Transform"]
    assert level == "ERROR"
    assert '"b" is more than 1e+12 m from "map", too far to draw' in text
    assert f'→ "b" with {far:.3g} m' in text or f'→ "a" with {far:.3g} m' in text
    level, text = b.statuses(1)["b"]
    assert level == "WARN"
    assert "too far to draw" in text
    (near,) = b.nodes(Axes, "display2")
    assert len(near.positions) == 1 + others + (far == REACH_M)


def test_a_chain_that_returns_within_reach_is_drawn(bench: Benches) -> None:
    b = bench(Marks(name="Marks"))
    b.transform("map", "a", T, 1e200)
    b.transform("a", "b", T, -1e200)
    b.pose("/pose", "b", T)
    b.turn()
    assert sorted(key for key, *_ in b.scene.visible()) == ["follower", "sample"]


def test_an_offset_out_of_reach_is_the_displays_fault(bench: Benches) -> None:
    b = bench(Marks(name="Marks", frame="a", offset=1e300), strict=False)
    b.transform("map", "a", T)
    b.turn()
    assert b.statuses()["Display"][1].startswith(
        "Marks failed: ValueError: The position (1e+300, 0, 0) m"
    )
    assert finite(b)


def test_a_view_does_not_follow_a_frame_out_of_reach(bench: Benches) -> None:
    b = bench(cameras=FollowingCamera("b"))
    b.transform("map", "a", T, 1e308)
    b.transform("a", "b", T, 1e308)
    b.turn()
    assert finite(b)
    b.turn(keep_up=True)
    assert "too far to draw" in b.states[-1].statuses["Target Frame"].text
