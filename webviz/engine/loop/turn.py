"""Steps of a turn of the frame loop: its pace, what has arrived, and what is drawn."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence

from webviz.api.declared import Color
from webviz.api.frames import Frames
from webviz.api.status import Level, Status
from webviz.engine.error_boundary import CRASHED, ErrorBoundary
from webviz.engine.parts import Batches, PartContext
from webviz.engine.parts.time import TimePart
from webviz.engine.parts.transforms import TransformsPart
from webviz.engine.parts.views import ViewsPart
from webviz.engine.pipeline import Runner
from webviz.engine.pipeline.scene import Scene

IDLE_S = 1.0
"""Interval of turns while nothing arrives: ages in statuses, frames that fade."""
LONG_IDLE_S = 4.0
"""The same once nothing has arrived for long: watching what stands still costs a third."""
QUIET_SHARE = 0.1
"""Interval of turns as a share of the time since something arrived."""


class Arrivals:
    """Takes what has arrived at the source, and resets all parts when time goes back.

    Args:
        context: shared by all parts.
        time: detects that time went back.
        transforms: inserts transforms before other parts look them up.
    """

    def __init__(self, context: PartContext, time: TimePart, transforms: TransformsPart) -> None:
        self._context = context
        self._time = time
        self._transforms = transforms

    def take(self) -> Batches:
        """Take what arrived since the last turn; while paused, messages wait in the inbox."""
        context, attempt = self._context, self._context.boundary.attempt
        batches: Batches = {}
        context.now_ns = attempt("Source", context.now_ns, context.player.now_ns)
        context.offers = attempt("Source", context.offers, context.player.offers)
        if self._time.is_paused:
            self._time.missed = attempt("Source", self._time.missed, context.player.inbox.hold)
        else:
            batches = attempt("Source", batches, context.player.inbox.drain)
        if attempt("Time", False, self._time.ros.step, context.now_ns):
            # Messages of this turn may be older or newer. Latched ones are requested again.
            batches = {}
            context.reset()
        if attempt("Transforms", False, self._transforms.insert, batches):
            self._time.ros.note("The transforms started over in the past: everything was reset.")
            context.reset()
        return batches


class FramePacing:
    """Spaces turns, so that there is one per period on average.

    After a rest two may follow at once: what arrives right after a turn does not wait.

    Args:
        clock: monotonic time in seconds.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._due = 0.0
        self._arrived_s = clock()

    def begin(self, now: float, period: float) -> None:
        """Note the beginning of a turn.

        Args:
            now: monotonic time in seconds.
            period: of turns, in seconds.
        """
        self._due = max(self._due, now - period) + period

    def rest(self, now: float) -> float:
        """Return the seconds until the next turn may begin."""
        return max(0.0, self._due - now)

    def wait(self, arrived: threading.Event) -> None:
        """Wait until something arrives, or a turn is due anyway."""
        quiet_s = self._clock() - self._arrived_s
        if arrived.wait(max(IDLE_S, min(LONG_IDLE_S, QUIET_SHARE * quiet_s))):
            self._arrived_s = self._clock()


class Showing:
    """Draws displays and moves views with their target frames.

    Args:
        scene: where to draw.
        views: of all browsers.
        boundary: around all calls.
    """

    def __init__(self, scene: Scene, views: ViewsPart, boundary: ErrorBoundary) -> None:
        self.statuses: dict[str, Status] = {}
        """Errors of drawing; the scene has dropped what failed, so they stay."""
        self._scene = scene
        self._views = views
        self._boundary = boundary
        self._background: Color | None = None

    def draw(self, runners: Sequence[Runner], frames: Frames, background: Color | None) -> None:
        """Update the scene and send what changed."""
        boundary = self._boundary
        if background != self._background:
            crashed = boundary("Scene", self._scene.set_background, background) is CRASHED
            self._background = self._background if crashed else background
        targets = boundary.attempt("Views", None, self._views.followed)
        followed = (runner.followed() for runner in runners)
        boundary("Transforms", frames.prepare, set[str]().union(targets or (), *followed))
        for runner in runners:
            runner.draw(frames)
        if targets is not None:
            boundary("Views", self._views.follow, targets, frames)
        if boundary("Drawing", self._scene.flush) is CRASHED:
            self.statuses["Scene"] = Status(Level.ERROR, boundary.crashes["Drawing"])
