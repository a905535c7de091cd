"""The frame loop: the one thread that changes displays, transforms, scene and panel."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from dataclasses import replace
from pathlib import Path
from typing import Any

from webviz.api.frames import Frames
from webviz.api.status import Status
from webviz.data.transforms import TransformBuffer, tree_text
from webviz.engine import plugins
from webviz.engine.commands import (
    Command,
    FocusDisplay,
    InspectTopic,
    InspectTransforms,
    Pause,
    Refresh,
    ReloadPlugin,
    Reset,
    ViewCommand,
)
from webviz.engine.display_list import DisplayList
from webviz.engine.hearing import Hearing
from webviz.engine.pipeline import Runner, Services, Workers
from webviz.engine.pipeline.guard import Guard
from webviz.engine.pipeline.stopwatch import Stopwatch
from webviz.engine.requests import Job, Requests
from webviz.engine.session import Session
from webviz.engine.showing import Scene, Showing
from webviz.engine.sources import Source, Subscription
from webviz.engine.state import Clock, File, State
from webviz.engine.statuses import failures, fixed_frame_status, import_status
from webviz.engine.viewing import Viewing
from webviz.files.config import Config, Settings

log = logging.getLogger("webviz")

IDLE_S = 0.25
"""How often to look around when nothing arrives: ages in statuses, frames that fade."""
PANEL_S = 0.2
FOLDER_S = 2.0
"""How often to look for config files that others wrote."""
AUTOSAVE_S = 2.0
TOLD_S = 15.0
"""How long to tell that a part of the viewer failed."""


class FrameLoop:
    """Keeps a scene true to a source, as a config says.

    Args:
        config: what to show; the viewer goes on from it.
        source: where messages come from.
        scene: where to draw.
        show: called with the state whenever a panel should show a new one.
        path: the file that the config came from, None for none.
        autosave: a file that follows every change, None for none.
        strict: raise what displays raise, as tests want it.
        clock: monotonic time in seconds, for rates and ages.
    """

    def __init__(
        self,
        config: Config,
        source: Source,
        scene: Scene,
        show: Callable[[State], None] = lambda state: None,
        *,
        path: Path | None = None,
        autosave: Path | None = None,
        strict: bool = False,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.buffer = TransformBuffer()
        self._guard = Guard("", strict, told_s=TOLD_S, clock=clock)
        self._hearing = Hearing(source, self.buffer, self._guard, clock)
        self._stopwatch = Stopwatch()
        self._paused_ns: int | None = None
        self._source = source
        self._inspects_transforms = False
        self._show = show
        self._workers = Workers(self._wake)
        self._services = Services(scene, self._workers, source.resolve, strict, clock)
        self._requests = Requests(self._guard, self._wake)
        self._stop = threading.Event()
        self._list = DisplayList(self._services)
        self._session = Session(self._list, config, path, autosave, self._opened)
        self._viewing = Viewing(scene)
        self._viewing.start_with(config.settings.view)
        self._showing = Showing(scene, self._viewing, self._guard)
        self._frames = Frames(self.buffer, self.settings.fixed_frame, 0)
        self._next_panel = self._next_folder = self._next_autosave = 0.0

    @property
    def settings(self) -> Settings:
        """All that is shown besides displays."""
        return self._session.settings

    def enqueue(self, command: Command) -> Future[str]:
        """Ask for a change from any thread; it is done on the next turn of the loop.

        Returns:
            What there is to tell of it, once it is done, drawn and shown; a
            `webviz.engine.requests.Refused` if it could not be done.
        """
        answer = self._requests.put(command)
        self._wake()
        return answer

    def stop(self) -> None:
        """End `run`, from any thread or a signal handler."""
        self._stop.set()
        self._wake()

    def run(self) -> None:
        """Work until `stop`: a turn as soon as something arrives, at most `frame_rate` a second."""
        arrived = self._source.inbox.arrived
        try:
            while not self._stop.is_set():
                began = time.monotonic()
                arrived.clear()
                self._guard("Frame loop", self.turn)
                rest = 1.0 / self.settings.frame_rate - (time.monotonic() - began)
                if rest > 0 and self._stop.wait(rest):
                    break
                arrived.wait(IDLE_S)
        finally:
            self.close()

    def close(self) -> None:
        """End the slow work beside the loop, and keep the last state if that is wanted."""
        self._requests.end()
        self._guard("Files", self._session.close)
        self._workers.close()

    def turn(self) -> None:
        """One turn of the frame loop."""
        answers = self._requests.obey(self._do)
        batches, is_over = self._hearing.take(self._paused_ns is not None)
        if is_over:
            self._forget()
        now_ns, offers = self._hearing.now_ns, self._hearing.offers
        shown_ns = now_ns if self._paused_ns is None else self._paused_ns
        frames = self._frames = self._frames.next(self.settings.fixed_frame, shown_ns)
        runners = self._list.active()
        for runner in runners:
            runner.take(batches, frames, offers)
        if self._showing.is_watched():
            self._showing.draw(runners, frames, self.settings.background)
        self._hearing.want(self._wanted())
        if answers or time.monotonic() >= self._next_panel:
            self._next_panel = time.monotonic() + PANEL_S
            self._guard("Files", self._keep_up, bool(answers))
            self._guard("Panel", self._show, self.state(frames))
        for answer in answers:
            answer()  # now that what was asked for can be seen

    def state(self, frames: Frames) -> State:
        """A snapshot for a panel."""
        attempt, hearing, offers = self._guard.attempt, self._hearing, self._hearing.offers
        topics = {
            topic: tuple(sorted({p.type for p in offer.publishers}))
            for topic, offer in offers.items()
        }
        is_paused = self._paused_ns is not None
        return State(
            self._list.rows(lambda runner: self._statuses_of(runner, frames)),
            self.settings.fixed_frame,
            tuple(sorted(self.buffer.frames())),
            topics,
            self._global_statuses(frames),
            self.settings,
            attempt("Files", File(), self._session.file),
            self._requests.answer,
            attempt("Time", Clock(), self._stopwatch.clock, frames.now_ns, is_paused),
            offers,
            attempt("Topics", {}, hearing.monitor.traffic),
            attempt("Topics", None, hearing.monitor.look, offers),
            attempt("Transforms", "", self._tree, frames),
            attempt("Views", {}, self._viewing.views),
        )

    def config(self) -> Config:
        """What to save to come back to this."""
        return self._session.config()

    # Commands

    def _do(self, command: Command) -> str | Job[Any]:
        match command:
            case Reset():
                self._reset()
                self._stopwatch.start()
            case Pause(paused):
                self._paused_ns = self._frames.now_ns if paused else None
            case InspectTopic(topic):
                self._hearing.monitor.inspected = topic
            case InspectTransforms(inspect):
                self._inspects_transforms = inspect
            case Refresh():
                pass  # every command is followed by a new state
            case ReloadPlugin(path):
                plugins.reload(path, self._list.runners())
                self._session.settings = self._list.read_again(self.settings)
            case _ if isinstance(command, ViewCommand):
                self._view(command)
            case _:
                return self._session.do(command)
        return ""

    def _view(self, command: ViewCommand) -> None:
        ids = self._list.within(command.display) if isinstance(command, FocusDisplay) else []
        new = self._viewing.do(command, self._frames, self.settings, ids)
        for key, value in new.items():
            self._session.set(key, value)
        self._viewing.start_with(self.settings.view)

    def _opened(self) -> None:
        self._viewing.open(self.settings.view)

    def _reset(self) -> None:
        self._hearing.reset()
        self._forget()

    def _forget(self) -> None:
        for runner in self._list.runners():
            self._guard("Displays", runner.reset)

    def _keep_up(self, commanded: bool) -> None:
        """What has to be done now and then, and after commands."""
        now = time.monotonic()
        if commanded:
            self._session.look()
            self._next_folder = 0.0
        if now >= self._next_folder:
            self._next_folder = now + FOLDER_S
            self._session.look_around()
        if now >= self._next_autosave:
            self._next_autosave = now + AUTOSAVE_S
            self._session.keep()

    # Parts of a turn

    def _wanted(self) -> Mapping[str, Subscription]:
        """All subscriptions by topic. The first display decides on the type and QoS of a topic."""
        wanted = self._hearing.subscriptions()
        for runner in self._list.active():
            for name, subscription in runner.subscriptions().items():
                first = wanted.setdefault(name, subscription)
                wanted[name] = replace(first, asked=max(first.asked, subscription.asked))
        return self._hearing.inspected() | wanted if self._showing.is_watched() else wanted

    def _statuses_of(self, runner: Runner, frames: Frames) -> Mapping[str, Status]:
        dropped = self._source.inbox.dropped
        return runner.statuses(self._hearing.offers, frames, dropped, self._showing.is_watched())

    def _global_statuses(self, frames: Frames) -> Mapping[str, Status]:
        statuses = {"Fixed Frame": fixed_frame_status(frames.fixed_frame, self.buffer)}
        statuses |= self._hearing.statuses(frames.now_ns)
        statuses |= self._guard.attempt("Views", {}, self._viewing.statuses, frames)
        if report := self._session.report:
            statuses["Import"] = import_status(report)
        return statuses | failures(self._guard.crashes) | self._showing.statuses

    def _tree(self, frames: Frames) -> str:
        wanted = self._inspects_transforms and self._showing.is_watched()
        return tree_text(self.buffer, frames.now_ns) if wanted else ""

    def _wake(self) -> None:
        self._source.inbox.arrived.set()
