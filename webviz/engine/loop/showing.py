"""Updates of the scene after displays, settings and views."""

from __future__ import annotations

from collections.abc import Sequence

from webviz.api.declared import Color
from webviz.api.frames import Frames
from webviz.api.status import Level, Status
from webviz.engine.guard import CRASHED, Guard
from webviz.engine.parts.views import ViewsPart
from webviz.engine.pipeline import Runner
from webviz.engine.pipeline.scene import Scene


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
