"""Displays of one dot, and the dots that a bench shows."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

from bench import Bench

from webviz import Context, Display, Input, Keep, Prop, Sample, Topic
from webviz.api.nodes import Points

POSE = "geometry_msgs/msg/PoseStamped"
SECOND = 1_000_000_000
T = 100 * SECOND
"""Time at which a bench begins."""


class PoseDot(Display):
    """A dot at each pose."""

    topic: Annotated[Topic, Input(POSE)] = Topic("/pose")
    size: Annotated[float, Prop(gt=0)] = 0.1
    count: Annotated[int, Prop(ge=0)] = 1
    seconds: Annotated[float, Prop(ge=0)] = 0.0

    def history(self) -> Keep:
        return Keep(self.count, self.seconds)

    def draw(self, sample: Sample, ctx: Context) -> None:
        x = sample.message.pose.position.x
        if x < 0:
            raise ValueError("negative")
        ctx.points("dot", [[x, 0, 0]], (255, 0, 0), self.size)
        ctx.ok("Dot", f"at {x}")


class FrameDot(Display):
    """A dot at the origin of a frame."""

    frame: str = "base"
    keeps_last: bool = False
    interval_s: float = 0.0

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        group = ctx.follow(self.frame, keep_last=self.keeps_last, interval_s=self.interval_s)
        group.points("dot", [[0, 0, 0]], (255, 255, 255), 0.1)


def dots(bench: Bench) -> list[float]:
    """The x of every visible dot in the fixed frame."""
    visible = ((pose, node) for _, pose, node in bench.scene.visible())
    return sorted(p.position[0] + float(n.xyz[0][0]) for p, n in visible if isinstance(n, Points))


def show_dot(bench: Bench, x: float = 0.0) -> None:
    """Show a pose at x, in a frame that stays at the origin of the map."""
    bench.transform("map", "base", T, static=True)
    bench.pose("/pose", "base", T, x)
    bench.turn()
