"""Steps of a turn of the frame loop: its pace, what has arrived, and what is drawn."""

from __future__ import annotations

from collections.abc import Sequence

from webviz.api.declared import Color
from webviz.api.frames import Frames
from webviz.api.status import Level, Status
from webviz.engine.guard import CRASHED, Guard
from webviz.engine.parts import Batches, Core
from webviz.engine.parts.time import TimePart
from webviz.engine.parts.transforms import TransformsPart
from webviz.engine.parts.views import ViewsPart
from webviz.engine.pipeline import Runner
from webviz.engine.pipeline.scene import Scene


class Arrivals:
    """Takes what has arrived at the source, and resets all parts when time goes back.

    Args:
        core: shared by all parts.
        time: detects that time went back.
        transforms: inserts transforms before other parts look them up.
    """

    def __init__(self, core: Core, time: TimePart, transforms: TransformsPart) -> None:
        self._core = core
        self._time = time
        self._transforms = transforms

    def take(self) -> Batches:
        """Take what arrived since the last turn; while paused, messages wait in the inbox."""
        core, attempt = self._core, self._core.guard.attempt
        batches: Batches = {}
        core.now_ns = attempt("Source", core.now_ns, core.player.now_ns)
        core.offers = attempt("Source", core.offers, core.player.offers)
        if self._time.is_paused:
            self._time.missed = attempt("Source", self._time.missed, core.player.inbox.hold)
        else:
            batches = attempt("Source", batches, core.player.inbox.drain)
        if attempt("Time", False, self._time.ros.step, core.now_ns):
            # Messages of this turn may be older or newer. Latched ones are requested again.
            batches = {}
            core.reset()
        if attempt("Transforms", False, self._transforms.insert, batches):
            self._time.ros.note("The transforms started over in the past: everything was reset.")
            core.reset()
        return batches


class FramePacing:
    """Spaces turns, so that there is one per period on average.

    After a rest two may follow at once: what arrives right after a turn does not wait.
    """

    def __init__(self) -> None:
        self._due = 0.0

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


class Showing:
    """Draws displays and moves views with their target frames.

    Args:
        scene: where to draw.
        views: of all browsers.
        guard: for all calls.
    """

    def __init__(self, scene: Scene, views: ViewsPart, guard: Guard) -> None:
        self.statuses: dict[str, Status] = {}
        """Errors of drawing; the scene has dropped what failed, so they stay."""
        self._scene = scene
        self._views = views
        self._guard = guard
        self._background: Color | None = None

    def draw(self, runners: Sequence[Runner], frames: Frames, background: Color | None) -> None:
        """Update the scene and send what changed."""
        guard = self._guard
        if background != self._background:
            crashed = guard("Scene", self._scene.set_background, background) is CRASHED
            self._background = self._background if crashed else background
        targets = guard.attempt("Views", None, self._views.followed)
        followed = (runner.followed() for runner in runners)
        guard("Transforms", frames.prepare, set[str]().union(targets or (), *followed))
        for runner in runners:
            runner.draw(frames)
        if targets is not None:
            guard("Views", self._views.follow, targets, frames)
        if guard("Drawing", self._scene.flush) is CRASHED:
            self.statuses["Scene"] = Status(Level.ERROR, guard.crashes["Drawing"])
