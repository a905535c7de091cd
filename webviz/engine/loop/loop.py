"""The frame loop: the one thread that changes displays, transforms, scene and panel."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from pathlib import Path
from typing import Any, TypeVar

from webviz.api.nodes import POINTS_HELD
from webviz.api.robots import NamespacedRobot, robots_of
from webviz.api.status import Status
from webviz.data.transforms import TransformBuffer
from webviz.engine.commands import PROGRAM, Command, Sender
from webviz.engine.driving import VelocityControllers
from webviz.engine.error_boundary import ErrorBoundary
from webviz.engine.examiner import Examiner
from webviz.engine.feature import features, missing_features
from webviz.engine.loop.turn import Arrivals, FramePacing, Showing
from webviz.engine.parts import Part, PartContext, Parts
from webviz.engine.parts.autosave import AutosavePart
from webviz.engine.parts.config import ConfigPart
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.parts.panels import PanelsPart
from webviz.engine.parts.part import NO_PROGRAM, HostProgram, P
from webviz.engine.parts.session import SessionPart
from webviz.engine.parts.settings import SettingsPart
from webviz.engine.parts.time import REWOUND, TimePart
from webviz.engine.parts.topics import TopicsPart
from webviz.engine.parts.transforms import TransformsPart
from webviz.engine.parts.views import ViewsPart
from webviz.engine.pipeline import DisplayServices, Runner, Workers
from webviz.engine.pipeline.own_names import rights_of
from webviz.engine.pipeline.point_budget import PointBudget
from webviz.engine.pipeline.scene import Scene
from webviz.engine.requests import LoopCalls, Requests
from webviz.engine.state import State
from webviz.files.config import Config, Settings
from webviz.sources import Advertisement, AllowList, RestrictedGraph, Source
from webviz.sources.player import Player
from webviz.sources.recording.memory import MemoryHistory

PANEL_S = 0.2
"""Interval of housekeeping (subscriptions, statuses, the panel) while a user attends to what
changes all the time, and after commands."""
CALM_S = 0.5
"""The same otherwise: it takes a fifth of a demo's processor time, five times a second."""
COMMANDED_S = 3.0
"""Time after a command in which people look at what it does."""
PAUSE_S = 0.002
"""Pause in seconds before housekeeping, in which what was drawn is sent, and new messages go
first."""
SEEKING_S = 0.1
"""Longest time in seconds of a turn while a recording is read up to a position."""
FAILURE_S = 15.0
"""Duration for which the failure of a part is shown."""

T = TypeVar("T")


class FrameLoop:
    """Draws the configured displays of a source in a scene.

    Args:
        config: what to show first.
        source: where messages come from; live topics are remembered, so that they can be rewound.
        scene: where to draw.
        show: called whenever pages should be updated.
        path: the file of the config, None if it has none.
        autoplay: play a recording as soon as a browser is connected; else it is paused first.
        may_publish: whether tools may publish, call services and send goals.
        allow_publish: names to which they may, besides those of the config.
        autosave: a file that follows every change, None for no autosave.
        session: a file that keeps unsaved changes for the next start, None for none.
        restore: whether to show those of the last one.
        parts: factories of additional parts.
        host: the program around it, for features.
        strict: let exceptions of displays through, for tests.
        clock: monotonic time in seconds, for rates and ages; None for that of the source, which
            stands still with a recording and while the past is shown.
    """

    def __init__(
        self,
        config: Config,
        source: Source,
        scene: Scene,
        show: Callable[[], object] = lambda: None,
        *,
        path: Path | None = None,
        autoplay: bool = False,
        may_publish: bool = True,
        allow_publish: Sequence[str] = (),
        autosave: Path | None = None,
        session: Path | None = None,
        restore: bool = True,
        parts: Sequence[Callable[[PartContext], Part]] = (),
        host: HostProgram = NO_PROGRAM,
        strict: bool = False,
        clock: Callable[[], float] | None = None,
    ) -> None:
        live_ns = source.now_ns
        player = source if isinstance(source, Player) else Player(MemoryHistory(source))
        self._source = player
        waiting, clock = clock or time.monotonic, clock or player.clock
        self._show = show
        self._stop = threading.Event()
        self._calls = LoopCalls(self._wake)
        self._boundary = ErrorBoundary("", strict, shown_s=FAILURE_S, clock=clock)
        self._requests = Requests(self._boundary, self._wake)
        self._workers = Workers(self._wake)
        self._next_panel = 0.0
        self._commanded_s = time.monotonic()
        self._offers: object = None
        self._part_statuses: Mapping[str, Status] = {}
        self._advertised: set[Advertisement] = set()
        self._named_robots: tuple[object, tuple[NamespacedRobot, ...]] = None, ()
        self._owed: list[Callable[[], None]] = []
        rights = rights_of(config, may_publish, allow_publish, self._boundary)
        graph = RestrictedGraph(player, rights, self._allow_list, self._pause)
        self.controllers = VelocityControllers(graph, live_ns)
        """Controllers of the vehicles that tools drive; they do not wait for the loop."""
        context = PartContext(
            player, graph, self.controllers, scene, self._boundary, clock, waiting, host
        )
        self.context = context
        """All that parts share."""
        services = self._services(strict)
        self._tracer = services.tracer
        transforms = TransformsPart(context, self._robots)
        self._time = TimePart(context, autoplay)
        self._displays = DisplaysPart(context, services)
        self._settings = SettingsPart(context)
        views = ViewsPart(context, self._settings, self._displays)
        first = [transforms, self._time, self._displays, self._settings, views]
        others, session_part = self._other_parts(config, path, views, player, autosave, session)
        context.parts = [*first, *others]
        attempt, kinds = self._boundary.attempt, features().values()
        own = [attempt(each.name, None, each, context) for each in kinds]
        context.parts += [*(make(context) for make in parts), *(each for each in own if each)]
        self._parts = Parts(context.parts, self._boundary)
        self._arrivals = Arrivals(context, self._time, transforms)
        self._showing = Showing(scene, views, self._boundary)
        self._move_on()
        self.restored: Future[str] | None = None
        """The answer to what restores the last session, None if there is none."""
        if session_part and (command := session_part.restored(restore)):
            self.restored = self._requests.put(command, PROGRAM)

    def _services(self, strict: bool) -> DisplayServices:
        """Make what all displays share."""
        return DisplayServices(
            self.context.scene,
            self._workers,
            self._source.resolve,
            strict,
            self.context.clock,
            graph=self.context.graph,
            wake=self._wake,
            robots=self._robots,
            points=PointBudget(self._points_held),
        )

    def _other_parts(
        self,
        config: Config,
        path: Path | None,
        views: ViewsPart,
        player: Player,
        autosave: Path | None,
        session: Path | None,
    ) -> tuple[list[Part], SessionPart | None]:
        """Make the parts that the loop itself does not ask, in the order of their turns."""
        context, displays, settings = self.context, self._displays, self._settings
        panels = PanelsPart(context, settings)
        files = self._files = ConfigPart(
            context, displays, settings, views, context.tools, panels.list, config, path
        )
        session_part = SessionPart(context, files, session) if session else None
        parts: list[Part] = [
            panels,
            files,
            TopicsPart(context),
            *([AutosavePart(context, files, autosave)] if autosave else ()),
            *([session_part] if session_part else ()),
        ]
        return parts, session_part

    @property
    def buffer(self) -> TransformBuffer:
        """All transforms."""
        return self.context.buffer

    @property
    def settings(self) -> Settings:
        """Everything in the config except its lists."""
        return self._settings.settings

    @property
    def parts(self) -> Sequence[Part]:
        """All parts and features."""
        return self.context.parts

    @property
    def doctor(self) -> Examiner:
        """The part that finds the causes behind statuses.

        Raises:
            webviz.Error: this viewer has none.
        """
        return self.get(Examiner)

    def get(self, kind: type[P]) -> P:
        """Return the part or feature of a class; see `PartContext.get`."""
        return self.context.get(kind)

    def runners(self) -> Sequence[Runner]:
        """Return the displays that are shown."""
        return self._displays.list.active()

    def enqueue(self, command: Command, sender: Sender = PROGRAM) -> Future[str]:
        """Enqueue a command from any thread; the next turn of the loop carries it out.

        Returns:
            Its answer, once its effect is drawn and shown; a
            `webviz.engine.requests.Refused` if it was refused.
        """
        answer = self._requests.put(command, sender)
        self._wake()
        return answer

    def stop(self) -> None:
        """End `run`, from any thread or a signal handler."""
        self.controllers.stop()
        self._stop.set()
        self._wake()

    def run(self) -> None:
        """Run until `stop`: a turn whenever something arrives, at most `frame_rate` per second."""
        arrived, pace = self._source.inbox.arrived, FramePacing()
        self._calls.begin()
        try:
            while not self._stop.is_set():
                pace.begin(time.monotonic(), 1.0 / self.settings.frame_rate)
                arrived.clear()
                self._boundary("Frame loop", self._advance)
                late = time.monotonic() - self._next_panel
                if late >= 0.0 and (late > PANEL_S or not arrived.wait(PAUSE_S)):
                    self._boundary("Frame loop", self._keep_up)
                pace.wait(arrived)
                if rest := pace.rest(time.monotonic()):
                    self._stop.wait(rest)
        finally:
            self.close()
            self._calls.end()

    def close(self) -> None:
        """Stop all vehicles, and end all threads and autosave."""
        self.controllers.close()
        self._requests.end()
        self._parts.close()
        self._workers.close()

    def turn(self, keep_up: bool = False) -> None:
        """One turn by hand, with the housekeeping that is due or asked for, or subscriptions."""
        self._advance()
        if keep_up or time.monotonic() >= self._next_panel:
            self._keep_up()
        else:
            self._subscribe()

    def _advance(self) -> None:
        """Carry out commands, take what has arrived, and draw it."""
        context = self.context
        self._calls.answer()
        self._owed += self._requests.obey(self._parts.do)
        self._receive()
        is_seeking = context.player.is_seeking
        answers, self._owed = ([], self._owed) if is_seeking else (self._owed, [])
        if context.is_watched() and not is_seeking:
            runners = self._displays.list.active()
            self._showing.draw(runners, context.frames, self.settings.background)
            self._tracer.sent()
        if answers:
            self._keep_up(commanded=True)
        elif context.offers is not self._offers:
            self._subscribe()
        for answer in answers:
            answer()  # once the effect is visible

    def _keep_up(self, commanded: bool = False) -> None:
        """Do the housekeeping."""
        now = time.monotonic()
        self._commanded_s = now if commanded else self._commanded_s
        is_attended = self._parts.is_attended() or now - self._commanded_s < COMMANDED_S
        self._next_panel = now + (PANEL_S if is_attended else CALM_S)
        self._subscribe()
        self._parts.keep_up(commanded)
        self._boundary("Publishers", self._advertise)
        self._boundary("Panel", self.update)
        self._boundary("Panel", self._show)

    def _subscribe(self) -> None:
        self._offers = self.context.offers
        self._boundary("Source", self._source.want, self._parts.subscriptions())

    def _advertise(self) -> None:
        """Have publishers for all that may be sent, so that first messages arrive.

        Those of vehicles only while browsers attend to them: it is the robot's own topic.
        """
        graph, stopping = self.context.graph, self.controllers.stopping()
        every = self._parts.advertisements() | self.controllers.advertisements()
        allowed = {each for each in every if not graph.lasting_refusal(each.topic)} | stopping
        if allowed != self._advertised:
            self._advertised = allowed
            graph.advertise(allowed, stopping)

    def _receive(self) -> None:
        """Take what has arrived; of a recording, as much as brings the position to be shown."""
        until = time.monotonic() + SEEKING_S
        while True:
            if self._source.is_seeking:
                # The source reads what they need of the past, and repeats what was latched if time
                # goes back on the way.
                self._subscribe()
            is_late = any(runner.is_late() for runner in self._displays.list.active())
            self._boundary("Playback", self._time.advance, is_late)
            batches = self._arrivals.take()
            self._move_on()
            self._parts.take(batches)
            if is_late or not self._source.is_seeking or time.monotonic() > until:
                return

    def update(self) -> None:
        """Have all parts note what there is to show, as of the last turn."""
        self._parts.update()
        if not self._source.is_seeking:  # on the way, transforms and messages are missing
            self._part_statuses = self._parts.statuses()
        own = self._boundary.statuses() | self._showing.statuses
        self.context.statuses = {**self._part_statuses, **own, **missing_features()}
        if not self._source.is_seeking:
            self._parts.review()

    def state(self) -> State:
        """Return all that programs may read, as of the last turn."""
        self.update()
        return self.context.state()

    def last_state(self) -> State:
        """Return the same, as of the last `update`."""
        return self.context.state()

    def fact(self, name: str, otherwise: Any = None) -> Any:
        """Return one field of the state, as of the last `update`; see `PartContext.fact`."""
        return self.context.fact(name, otherwise)

    @property
    def statuses(self) -> Mapping[str, Status]:
        """Statuses of the viewer as a whole, as of the last `update`."""
        return self.context.statuses

    def call(self, read: Callable[[], T]) -> Future[T]:
        """Call something between two turns, from any thread."""
        return self._calls.put(read)

    def is_busy(self) -> bool:
        """Return whether a display is loading something that it has not drawn yet."""
        return any(runner.is_busy() for runner in self._displays.list.active())

    def config(self) -> Config:
        """Return the current config."""
        return self._files.config()

    def _move_on(self) -> None:
        """Look up frames at the time that is shown now."""
        context = self.context
        context.frames = context.frames.next(self.settings.fixed_frame, self._time.shown_ns)

    def _allow_list(self) -> AllowList | None:
        return self.settings.publish

    def _pause(self) -> str:
        return "" if self._source.is_live else REWOUND

    def _points_held(self) -> int:
        return self._boundary.attempt("Scene", POINTS_HELD, self.context.scene.points_held)

    def _robots(self) -> tuple[NamespacedRobot, ...]:
        entries = self.settings.robots
        if entries is not self._named_robots[0]:
            self._named_robots = entries, robots_of(entries)
        return self._named_robots[1]

    def _wake(self) -> None:
        self._source.inbox.arrived.set()
