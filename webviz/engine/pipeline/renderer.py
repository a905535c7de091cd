"""Calls the drawing hooks of one display and updates the scene."""

from __future__ import annotations

import copy
import functools
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from typing import Any

import msgspec

from webviz.api.context import ColorScale, Context, Placement
from webviz.api.display import Display, overrides
from webviz.api.frames import Frames
from webviz.api.picking import Details, Hit
from webviz.api.sample import Sample
from webviz.api.status import Status
from webviz.engine.error_boundary import CRASHED, ErrorBoundary
from webviz.engine.pipeline.background import Tasks, Workers, is_slow
from webviz.engine.pipeline.baking import bake
from webviz.engine.pipeline.history import BufferedSample, Histories, SampleHistory, held_samples
from webviz.engine.pipeline.point_budget import PointBudget
from webviz.engine.pipeline.scene_diff import SceneDiff, groups_of

_NO_STATE = object()

Look = tuple[Sample, int]
"""A sample, and a number that changes with everything else that its drawing depends on."""


class DrawReport(msgspec.Struct, frozen=True):
    """Words of a hook on what it has drawn, besides the nodes.

    Args:
        statuses: by key.
        color_scale: range of values that colours stand for, None without one.
        attribution: text of the credit, "" for none.
        offered: names for switches by property; see `Context.offered`.
    """

    statuses: Mapping[str, Status] = {}
    color_scale: ColorScale | None = None
    attribution: str = ""
    offered: Mapping[str, Mapping[str, int]] = {}


class _DrawJob(msgspec.Struct, frozen=True):
    """A sample that is drawn in a worker.

    Args:
        buffered: the sample.
        look: to compare with what is wanted when it is done.
        context: collects its nodes.
        done: when it has.
    """

    name: str
    buffered: BufferedSample
    look: Look
    context: Context
    done: Future[None]


class Renderer:
    """The drawing of one display: its nodes, its statuses and its slow work.

    Args:
        id: unique name in the scene.
        diff: of the display, where it draws.
        workers: for slow work.
        points: how many points each display may show.
    """

    def __init__(self, id: str, diff: SceneDiff, workers: Workers, points: PointBudget) -> None:
        self.order = 0
        self.is_stale = True
        """True if everything must be redrawn, such as after a property changed."""
        self._id = id
        self._workers = workers
        self._points = points
        self._diff = diff
        self._tasks = Tasks(workers)
        self._state: Any = _NO_STATE
        self._reports: dict[str, DrawReport] = {}
        """The last one of each source; calls with one source replace each other's."""
        self._looks: dict[str, dict[int, Look | None]] = {}
        """Nodes by input and slot; None for what is outdated."""
        self._version = 0
        self._draw_job: _DrawJob | None = None
        self._versions: list[tuple[SampleHistory, int]] | None = None
        self._depended: object = None
        self._is_unfinished = False

    def draw(
        self, display: Display, boundary: ErrorBoundary, histories: Histories, frames: Frames
    ) -> None:
        """Call the hooks that have something new to draw, and move groups with their frames."""
        if not self._has_state(display, boundary):
            return
        self._is_unfinished = False
        depends = self._depends_on_news(display, boundary, frames)
        self.is_stale |= depends or self._tasks.has_news()
        self._version += self.is_stale
        versions = [(history, history.version) for history in histories.values()]
        changed = self._finish_job(boundary, histories, frames)
        changed |= self.is_stale or self._versions != versions
        if changed and overrides(display, "draw"):
            for name, history in histories.items():
                self._draw_samples(name, display, boundary, history, frames)
        if changed and overrides(display, "draw_all"):
            every = held_samples(histories)
            context = self._context(frames)
            self._call("all", boundary, display.draw_all, context, every, samples=every)
        if overrides(display, "tick"):
            self._call("tick", boundary, display.tick, self._context(frames))
        if changed:
            self._tasks.cancel_unrequested()
        self._versions = versions
        self.is_stale = False
        self._diff.move(frames)
        if self._is_unfinished:
            self._workers.wake()

    def hide(self) -> None:
        """Remove everything from the scene until the next call of `draw`."""
        self._diff.clear()
        self._looks.clear()
        self._drop_job()
        self._points.leave(self._id)
        self._is_unfinished = False
        self.is_stale = True

    def forget(self) -> None:
        """Discard the state of the display; what is drawn stays until something is drawn anew."""
        self._drop_job()
        self._diff.forget_poses()
        self._looks = {name: dict.fromkeys(looks) for name, looks in self._looks.items()}
        self._state = _NO_STATE
        self.is_stale = True

    def close(self) -> None:
        """Remove everything from the scene, and end the slow work."""
        self.hide()
        self._tasks.close()

    def replace(self, display: Display) -> None:
        """Continue with an instance of another class, keeping what is drawn."""
        self._drop_job()
        self._tasks.close()
        self._tasks = Tasks(self._workers)
        self._state = _NO_STATE
        self._reports.clear()
        samples = [_scope(name, slot) for name, looks in self._looks.items() for slot in looks]
        for hook, scopes in (("draw", samples), ("draw_all", ["all"]), ("tick", ["tick"])):
            for scope in () if overrides(display, hook) else scopes:
                self._diff.remove(scope)
        self.is_stale = True

    def inspect(
        self, display: Display, boundary: ErrorBoundary, hit: Hit, frames: Frames
    ) -> Details | None:
        """Return the details the display reports of a selected item, if it still exists."""
        if self._state is _NO_STATE:
            return None
        return boundary.attempt("inspect", None, display.inspect, hit, self._context(frames))

    def has(self, sample: Sample) -> bool:
        """Return whether a sample is drawn, alone or with others."""
        looks = self._looks.get(sample.input)
        return looks is None or any(look and sample is look[0] for look in looks.values())

    def is_busy(self) -> bool:
        """Return whether the result of slow work is not drawn yet."""
        return self._draw_job is not None or self._tasks.is_busy() or self._is_unfinished

    @property
    def busy_with(self) -> int:
        """Size of the message that is drawn in a worker, in bytes; 0 if none is."""
        return self._draw_job.buffered.size if self._draw_job else 0

    def report(self) -> DrawReport:
        """Return the last reports of all hooks as one: of statuses, the worst of each key."""
        statuses: dict[str, Status] = {}
        offered: dict[str, Mapping[str, int]] = {}
        scale, attribution = None, ""
        for each in self._reports.values():
            for key, status in each.statuses.items():
                before = statuses.setdefault(key, status)
                statuses[key] = status if status.level >= before.level else before
            offered |= each.offered
            scale, attribution = scale or each.color_scale, attribution or each.attribution
        return DrawReport(statuses, scale, attribution, offered)

    def context(self, display: Display, boundary: ErrorBoundary, frames: Frames) -> Context | None:
        """Return a context for hooks that do not draw; None without a state."""
        return self._context(frames) if self._has_state(display, boundary) else None

    def _has_state(self, display: Display, boundary: ErrorBoundary) -> bool:
        if self._state is _NO_STATE:
            state = boundary("new_state", display.new_state)
            self._state = _NO_STATE if state is CRASHED else state
        return self._state is not _NO_STATE

    def _depends_on_news(self, display: Display, boundary: ErrorBoundary, frames: Frames) -> bool:
        if not overrides(display, "depends"):
            return False
        context = self._context(frames)
        before, self._depended = self._depended, boundary("depends", display.depends, context)
        self._is_unfinished |= context.is_unfinished
        return self._depended != before

    def _draw_samples(
        self,
        name: str,
        display: Display,
        boundary: ErrorBoundary,
        history: SampleHistory,
        frames: Frames,
    ) -> None:
        """Draw the new samples of one input, the large ones one after another in a worker."""
        looks = self._looks.setdefault(name, {})
        samples = {buffered.slot: buffered for buffered in history.entries if buffered.has_pose}
        for slot in looks.keys() - samples.keys():
            self._diff.remove(_scope(name, slot))
            del looks[slot]
        for slot, buffered in samples.items():
            look = buffered.sample, self._version
            if looks.get(slot) == look:
                continue
            if not is_slow(display, buffered.size):
                looks[slot] = look
                context = self._context(frames, Placement(offset=buffered.sample.pose))
                scope = _scope(name, slot)
                sample = buffered.sample
                self._call(
                    scope,
                    boundary,
                    display.draw,
                    context,
                    sample,
                    samples=(sample,),
                    source=_status_source(name),
                )
            elif self._draw_job is None:
                self._send(name, display, buffered, look, frames)
        if not samples:
            self._reports.pop(_status_source(name), None)

    def _send(
        self, name: str, display: Display, buffered: BufferedSample, look: Look, frames: Frames
    ) -> None:
        """Draw a sample in a worker."""
        context = self._context(frames, Placement(offset=buffered.sample.pose))
        origins = self._diff.origins(_scope(name, buffered.slot))
        display = copy.copy(display)  # its properties may be set meanwhile

        def draw() -> None:
            display.draw(buffered.sample, context)
            for key, group in groups_of(context).items():
                bake(group, origins.get(key, (0.0, 0.0, 0.0)))

        self._draw_job = _DrawJob(name, buffered, look, context, self._workers.submit(draw))

    def _finish_job(self, boundary: ErrorBoundary, histories: Histories, frames: Frames) -> bool:
        """Show what was drawn in a worker; whether there was anything.

        It is shown even if a newer message waits: else nothing is, if they come faster than they
        are drawn.
        """
        job = self._draw_job
        if job is None or not job.done.done():
            return False
        self._draw_job = None
        name, slot = job.name, job.buffered.slot
        is_held = any(
            buffered.slot == slot and buffered.has_pose for buffered in histories[name].entries
        )
        if is_held and job.context.frames.fixed_frame == frames.fixed_frame:
            self._looks[name][slot] = job.look
            samples = (job.buffered.sample,)
            scope, context, source = _scope(name, slot), job.context, _status_source(name)
            self._call(scope, boundary, _result, context, job.done, samples=samples, source=source)
        return True

    def _drop_job(self) -> None:
        if self._draw_job is not None:
            self._workers.cancel(self._draw_job.done)
            self._draw_job = None

    def _context(self, frames: Frames, placement: Placement = Placement()) -> Context:
        share = functools.partial(self._points.share, self._id)
        return Context(frames, self._tasks, self._state, placement, self.order, share)

    def _call(
        self,
        scope: str,
        boundary: ErrorBoundary,
        hook: Callable[..., None],
        context: Context,
        *args: Any,
        samples: Sequence[Sample] = (),
        source: str = "",
    ) -> None:
        """Call a hook that draws and update the scene; after a crash the previous nodes stay."""
        if boundary(scope, hook, *args, context) is CRASHED:
            return
        self._is_unfinished |= context.is_unfinished
        self._diff.replace(scope, context, samples)
        self._reports[source or scope] = DrawReport(
            context.statuses, context.color_scale, context.attribution, context.offered
        )


def _result(future: Future[None], context: Context) -> None:
    """Raise what the hook of a sample raised in the worker that drew it."""
    future.result()


def _status_source(name: str) -> str:
    return f"sample of {name}"


def _scope(name: str, slot: int) -> str:
    return f"{name}.{slot}"
