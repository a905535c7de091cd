"""The frame loop: the one thread that changes displays, transforms, scene and panel."""

from __future__ import annotations

import logging
import queue
import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Protocol

import msgspec

from webviz import config as config_file
from webviz import plugins
from webviz.commands import (
    AddDisplay,
    Command,
    ReloadPlugin,
    RemoveDisplay,
    Reset,
    SetFixedFrame,
    SetProperty,
)
from webviz.config import Config
from webviz.display import make
from webviz.display_list import DisplayList
from webviz.frames import Frames
from webviz.pipeline import Runner, Services, Workers
from webviz.pipeline.drawing import Scene as DrawingScene
from webviz.pipeline.listener import TransformListener
from webviz.pipeline.ros_time import RosTime
from webviz.registry import display_types
from webviz.sources import Offer, Source, Subscription
from webviz.state import State
from webviz.status import Level, Status
from webviz.transforms import TransformBuffer

log = logging.getLogger("webviz")

IDLE_S = 0.25
"""How often to look around when nothing arrives: ages in statuses, frames that fade."""
PANEL_S = 0.2
MAX_COMMANDS = 1000


class Scene(DrawingScene, Protocol):
    """What the viewer needs of a scene besides drawing; see `webviz.scene.Scene`."""

    def flush(self) -> None:
        """Send everything that changed since the last flush."""
        ...

    def has_watchers(self) -> bool:
        """Whether anybody looks."""
        ...


class Viewer:
    """Keeps a scene true to a source, as a config says.

    Args:
        config: what to show; the viewer goes on from it.
        source: where messages come from.
        scene: where to draw.
        show: called with the state whenever a panel should show a new one.
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
        strict: bool = False,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.settings = config.settings
        self.buffer = TransformBuffer()
        self._listener = TransformListener(self.buffer, clock)
        self._time = RosTime(clock)
        self._frames = Frames(self.buffer, self.settings.fixed_frame, 0)
        self._source = source
        self._scene = scene
        self._show = show
        self._workers = Workers(self._wake)
        self._services = Services(scene, self._workers, source.resolve, strict, clock)
        self._commands: queue.Queue[Command] = queue.Queue(MAX_COMMANDS)
        self._stop = threading.Event()
        self._list = DisplayList(self._services)
        self._statuses: dict[str, Status] = {}
        if config.report:
            text = f"Not all of the .rviz file has a counterpart here. {' '.join(config.report)}"
            self._statuses["Import"] = Status(Level.WARN, text)
        self._next_panel = 0.0
        for item in config.displays:
            self._list.add(item)

    def enqueue(self, command: Command) -> None:
        """Ask for a change from any thread; it is done on the next turn of the loop."""
        try:
            self._commands.put_nowait(command)
        except queue.Full:
            log.warning("Too many requests at once, ignored: %s", command)
        self._wake()

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
                self.turn()
                rest = 1.0 / self.settings.frame_rate - (time.monotonic() - began)
                if rest > 0 and self._stop.wait(rest):
                    break
                arrived.wait(IDLE_S)
        finally:
            self._workers.close()

    def turn(self) -> None:
        """One turn of the frame loop."""
        commanded = self._obey()
        batches = self._source.inbox.drain()
        now_ns, offers = self._source.now_ns(), self._source.offers()
        if self._time.step(now_ns):
            # What arrived with it may be older or newer; what is latched is asked for again.
            batches = {}
            self._reset()
        if self._listener.take(batches, offers):
            self._time.tell("The transforms started over in the past: everything was reset.")
            self._reset()
        frames = self._frames = self._frames.next(self.settings.fixed_frame, now_ns)
        runners = self._list.active()
        for runner in runners:
            runner.take(batches, frames, offers)
        if self._scene.has_watchers():
            frames.prepare(set().union(*(runner.followed() for runner in runners)))
            for runner in runners:
                runner.draw(frames)
            self._flush()
        self._source.want(self._wanted())
        if commanded or time.monotonic() >= self._next_panel:
            self._next_panel = time.monotonic() + PANEL_S
            self._show(self.state(frames))

    def state(self, frames: Frames) -> State:
        """A snapshot for a panel."""
        offers = self._source.offers()
        topics = {
            topic: tuple(sorted({p.type for p in offer.publishers}))
            for topic, offer in offers.items()
        }
        return State(
            self._list.rows(lambda runner: self._statuses_of(runner, frames)),
            self.settings.fixed_frame,
            tuple(sorted(self.buffer.frames())),
            topics,
            {"Fixed Frame": self._fixed_frame_status(), **self._global_statuses(offers, frames)},
        )

    def config(self) -> Config:
        """What to save to come back to this."""
        return Config(self.settings, self._list.items())

    # Commands

    def _obey(self) -> bool:
        obeyed = False
        while not self._commands.empty():
            command = self._commands.get_nowait()
            obeyed = True
            try:
                self._do(command)
            except (msgspec.ValidationError, AttributeError, KeyError) as error:
                log.warning("Refused %s: %s", command, error)
        return obeyed

    def _do(self, command: Command) -> None:
        match command:
            case SetProperty(id, path, value):
                self._list.set(id, path, value)
            case AddDisplay(type, values, group):
                self._list.add(make(display_types()[type], values), self._list.group(group))
            case RemoveDisplay(id):
                self._list.remove(id)
            case SetFixedFrame(frame):
                self.settings = msgspec.structs.replace(self.settings, fixed_frame=frame)
            case Reset():
                self._reset()
            case ReloadPlugin(path):
                plugins.reload(path, self._list.runners())
                self._list.read_again()

    def _reset(self) -> None:
        self._listener.reset()
        for runner in self._list.runners():
            runner.reset()

    # Parts of a turn

    def _flush(self) -> None:
        try:
            self._scene.flush()
        except Exception as error:  # a display made a malformed node; the scene has dropped it
            if self._services.strict:
                raise
            text = " ".join([str(error), *getattr(error, "__notes__", ())])
            if "Scene" not in self._statuses or text not in self._statuses["Scene"].text:
                log.exception("A node could not be drawn")
            self._statuses["Scene"] = Status(Level.ERROR, f"A node could not be drawn: {text}")

    def _wanted(self) -> Mapping[str, Subscription]:
        """All subscriptions by topic. The first display decides on the type and QoS of a topic."""
        wanted = self._listener.subscriptions()
        for runner in self._list.active():
            for name, subscription in runner.subscriptions().items():
                first = wanted.setdefault(name, subscription)
                wanted[name] = replace(first, asked=max(first.asked, subscription.asked))
        return wanted

    def _statuses_of(self, runner: Runner, frames: Frames) -> Mapping[str, Status]:
        return runner.statuses(self._source.offers(), frames, self._source.inbox.dropped)

    def _global_statuses(self, offers: Mapping[str, Offer], frames: Frames) -> Mapping[str, Status]:
        time_status = self._time.status(offers)
        times = {"Time": time_status} if time_status else {}
        return times | self._listener.statuses(offers, frames.now_ns) | self._statuses

    def _fixed_frame_status(self) -> Status:
        fixed_frame, known = self.settings.fixed_frame, self.buffer.frames()
        if fixed_frame in known:
            return Status(Level.OK, "OK")
        if not known:
            return Status(
                Level.WARN, f"No transforms yet on /tf or /tf_static, so {fixed_frame} is unknown."
            )
        hint = config_file.nearest(fixed_frame, known)
        return Status(Level.ERROR, f"Nobody publishes a frame named {fixed_frame}: {hint}")

    def _wake(self) -> None:
        self._source.inbox.arrived.set()
