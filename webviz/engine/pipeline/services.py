"""Services shared by the displays of a viewer."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence

import msgspec

from webviz.api.nodes import POINTS_HELD
from webviz.api.robots import NamespacedRobot
from webviz.engine.pipeline.background import Workers
from webviz.engine.pipeline.history import HistoryBudget
from webviz.engine.pipeline.point_budget import PointBudget
from webviz.engine.pipeline.scene_diff import SceneWriter
from webviz.engine.pipeline.trace import Tracer
from webviz.sources import RestrictedGraph


class DisplayServices(msgspec.Struct, frozen=True):
    """Shared by all runners.

    Args:
        scene: where to draw.
        workers: for slow work.
        resolve: the full name of a topic; raises ValueError.
        strict: let exceptions of displays through, for tests.
        clock: monotonic time in seconds, for rates and ages.
        tracer: traces samples on request.
        graph: for displays that follow a protocol of their own; None if they cannot.
        wake: makes the frame loop turn again soon.
        robots: whose topics and frames have a name of their own.
        points: how many points each display may show.
        histories: how many bytes of messages all displays hold.
    """

    scene: SceneWriter
    workers: Workers
    resolve: Callable[[str], str]
    strict: bool = False
    clock: Callable[[], float] = time.monotonic
    tracer: Tracer = msgspec.field(default_factory=lambda: Tracer(time.monotonic))
    graph: RestrictedGraph | None = None
    wake: Callable[[], None] = lambda: None
    robots: Callable[[], Sequence[NamespacedRobot]] = tuple
    points: PointBudget = msgspec.field(default_factory=lambda: PointBudget(lambda: POINTS_HELD))
    histories: HistoryBudget = msgspec.field(default_factory=HistoryBudget)
