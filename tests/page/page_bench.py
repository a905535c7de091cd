"""A viewer with pages, whose frame loop a test turns."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future
from contextlib import contextmanager
from functools import partial
from operator import attrgetter
from pathlib import Path
from typing import Any, TypeVar

from bench import Bench

from tests.page.everything import Everything
from webviz.api.panel import Panel
from webviz.api.status import Status
from webviz.api.views import Orbit
from webviz.commands import InspectSelections, OpenPanels, Refresh, Reset
from webviz.data.messages import encode
from webviz.engine.commands import PROGRAM, Command, Sender
from webviz.engine.parts.config import ConfigPart
from webviz.engine.parts.declaring import command, commands_of
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.parts.panels import PanelsPart
from webviz.engine.parts.part import Part
from webviz.engine.parts.settings import SettingsPart
from webviz.engine.parts.time import TimePart
from webviz.engine.parts.views import ViewsPart
from webviz.engine.state import Row, State
from webviz.features.undo import UndoFeature, UndoHistory
from webviz.files.config import Branch, Config, Item, Settings
from webviz.page.pages import Pages
from webviz.scene import ViserScene, open_server
from webviz.server.access.access import Access
from webviz.server.channel.channel import Channel
from webviz.server.channel.messages import FromPage
from webviz.shell.testing.messages import header, stamped_transform
from webviz.shell.testing.recording import RecordingScene
from webviz.shell.testing.remembering_graph import RememberingGraph
from webviz.shell.testing.source import SECOND
from webviz.sources import Offer, Publisher, Raw
from webviz.sources.past_state import PlaybackState

L = TypeVar("L", bound=Panel)
SCAN, TRANSFORMS = "sensor_msgs/msg/LaserScan", "tf2_msgs/msg/TFMessage"
FRAME_S = 0.02
NOT_CLICKED = (InspectSelections, OpenPanels, Refresh)
"""Commands that follow from what pages watch."""


class ConfigsOfTests(Part):
    """Shows the configs of tests, as `Load` does, which reads one from a text."""

    @command(None)
    def show_config(self, config: Config, path: Path | None) -> None:
        """Show another config, which has a file or none."""
        self.context.get(ConfigPart).open(config, path)


ShowConfig = commands_of(ConfigsOfTests)["ShowConfig"].type


class OneViewerChannel:
    """The channel of a server, whose messages go to the newest of several viewers.

    Args:
        channel: of the server.
    """

    def __init__(self, channel: Channel) -> None:
        self._channel = channel
        self._listeners: dict[type[FromPage], list[Callable[[int, Any], object]]] = {}

    def __getattr__(self, name: str) -> Any:
        return getattr(self._channel, name)

    def on(self, kind: type[FromPage], listener: Callable[[int, Any], object]) -> None:
        """Call a listener with each message of a kind."""
        if kind not in self._listeners:
            self._channel.on(kind, partial(self._hear, kind))
        self._listeners.setdefault(kind, []).append(listener)

    def begin(self) -> None:
        """Have no listeners any more."""
        for listeners in self._listeners.values():
            listeners.clear()

    def _hear(self, kind: type[FromPage], browser: int, message: Any) -> None:
        for listener in tuple(self._listeners[kind]):
            listener(browser, message)


class PageServer:
    """A server whose pages show one viewer after another, as if each was started anew.

    The loop of the viewer also turns while a test waits for its browser, whose driver then runs an
    event loop in the thread of the test: so the browser is there before.

    Args:
        access: knows the tokens; None if none are asked for.
    """

    def __init__(self, access: Access | None = None) -> None:
        self.server = open_server(port=0, access=access)
        self.access = access
        self.scene = ViserScene(self.server)
        self.channel = OneViewerChannel(self.server.channel)
        self.viewer = PageBench(self)
        """Newest viewer."""
        self.errors: list[Exception] = []
        """Errors of turns while a test waited."""
        self._is_paused = False
        self._loop = asyncio.get_running_loop()
        self._next_turn = self._loop.call_later(FRAME_S, self._turn)

    def begin(self, is_linked: bool = True, ago_s: float = 0.0, **options: Any) -> PageBench:
        """Start a viewer without displays, which has one transform unless it is not linked.

        Args:
            is_linked: publish the transform.
            ago_s: seconds since the transform arrived, from when on its memory can hold messages;
                if there are any, ROS time is that of the machine.
            options: for `Bench`.
        """
        self.viewer.close()
        self.channel.begin()
        self.scene.cameras.show(Orbit())
        self.viewer = PageBench(self, **options)
        Everything.reported.clear()
        if ago_s:
            self.viewer.source.now = time.time_ns()
            self.viewer.do(Reset())
        if is_linked:
            self.viewer.link("map", "base_link", ago_s=ago_s)
        return self.viewer

    @contextmanager
    def paused(self) -> Iterator[None]:
        """Turn the loop only when a test does."""
        self._is_paused = True
        yield
        self._is_paused = False

    def close(self) -> None:
        """End all; no turn may have failed."""
        self._next_turn.cancel()
        self.viewer.close()
        self.server.stop()
        assert self.errors == []

    def _turn(self) -> None:
        begun = time.monotonic()
        try:
            if not self._is_paused:
                self.viewer.turn()
        except Exception as error:  # the loop would only log it
            self.errors.append(error)
        pause_s = max(FRAME_S, 3 * (time.monotonic() - begun))
        self._next_turn = self._loop.call_later(pause_s, self._turn)


class PageBench(Bench):
    """A `Bench` whose viewer has pages: they show it, and their commands are carried out.

    Each turn does the housekeeping, too, so that the pages are sent what has changed.

    Args:
        page_server: of the pages.
        options: for `Bench`.
    """

    def __init__(self, page_server: PageServer, **options: Any) -> None:
        self.server = page_server.server
        self.commands: list[Command] = []
        """Commands of pages that were carried out or refused, but for those that no click makes."""
        self._checked = 0
        """Number of them up to the last that `has_received` has found."""
        self.senders: list[Sender] = []
        """Sender of each."""
        self._pages: Pages | None = None
        self._channel = page_server.channel
        viser = page_server.scene
        scene = RecordingScene(cameras=viser.cameras, browsers=viser.browsers)
        scene.attach(viser)
        self._graph = RememberingGraph()
        own: dict[str, Any] = {"parts": (ConfigsOfTests,), "publish": None}
        super().__init__(scene=scene, graph=self._graph, **own | options)
        channel: Any = page_server.channel
        self._pages = Pages(channel, self._enqueue, page_server.access, parts=self.viewer.parts)
        self.server.channel.on_watch = channel.on_watch
        self.server.channel.may_watch = channel.may_watch

    def close(self) -> None:
        """End the viewer, and clear its scene."""
        self.viewer.close()
        self.scene.detach()

    def listen(self, kind: type[FromPage], listener: Callable[[int, Any], object]) -> None:
        """Call a listener with the browser and the message, of each message of a kind of pages."""
        self._channel.on(kind, listener)

    def forget_commands(self) -> None:
        """Forget the commands that came so far."""
        self.commands.clear()
        self.senders.clear()
        self._checked = 0

    def has_received(self, command: Command) -> bool:
        """Return whether a command came after those that earlier calls have found."""
        if command not in self.commands[self._checked :]:
            return False
        self._checked = self.commands.index(command, self._checked) + 1
        return True

    def show(
        self,
        *displays: Item,
        tools: Sequence[Any] = (),
        panels: Sequence[Any] = (),
        path: Path | None = None,
        **settings: Any,
    ) -> None:
        """Open a config, in the name of the first browser: others would say so in a toast."""
        config = Config(Settings(**settings), list(displays), list(tools), list(panels))
        first = min(self.server.channel.browsers(), default=None)
        self.do(ShowConfig(config, path), Sender(first))

    def do(self, command: Command, sender: Sender = PROGRAM) -> State:
        """Run a command, which must not be refused, and return the state that panels show."""
        self.until_done(answer := self.viewer.enqueue(command, sender))
        answer.result(0)
        return self.states[-1]

    def turn(self, keep_up: bool = True) -> None:
        super().turn(keep_up)

    def report(self, **statuses: Mapping[str, Status]) -> None:
        """Have displays of the type `Everything` report these from now on, by name."""
        Everything.reported.update(statuses)

    def pass_time(self, seconds: float) -> None:
        """Let ROS time and the clock go on."""
        self.clock += seconds
        self.source.now += round(seconds * SECOND)

    def link(self, parent: str, *children: str, ago_s: float = 0.0) -> None:
        """Publish static transforms, which arrived some seconds ago."""
        for child in children:
            transforms = [stamped_transform(parent, child, 0)]
            self.publish_past(ago_s, "/tf_static", TRANSFORMS, {"transforms": transforms})
        self.turn()

    def publish_past(
        self, ago_s: float, topic: str, type_name: str, values: Mapping[str, Any]
    ) -> None:
        """Publish a message as if it had arrived some seconds ago, later than all before."""
        if topic not in self.source.topics:
            self.offer(topic, type_name, "/test")
        received_ns = self.source.now - round(ago_s * SECOND)
        raw = Raw(encode(type_name, values), received_ns, time.monotonic() - ago_s)
        self.source.inbox.put(topic, raw)

    def offer(self, topic: str, type_name: str, *nodes: str, problem: str = "") -> None:
        """Have publishers of a topic, best effort and volatile."""
        publishers = (Publisher(each, type_name, "best_effort", "volatile") for each in nodes)
        self.source.topics[topic] = Offer(tuple(publishers), ("best_effort", "volatile"), problem)

    @property
    def rows(self) -> Sequence[Row]:
        """The displays as of the last turn."""
        return self.viewer.get(DisplaysPart).rows

    @property
    def playback(self) -> PlaybackState:
        """The recording that is played, or the memory of live topics, as of the last turn."""
        playback = self.viewer.get(TimePart).playback
        assert playback is not None
        return playback

    def panel(self, kind: type[L]) -> L:
        """The first panel of a type."""
        panels = [tab.panel for tab in self.viewer.get(PanelsPart).tabs()]
        return next(each for each in panels if isinstance(each, kind))

    @property
    def settings(self) -> Settings:
        """Everything in the config except its lists."""
        return self.viewer.get(SettingsPart).settings

    def row(self, name: str) -> Row:
        """The display of a name."""
        (row,) = (row for row in self.rows if row.name == name)
        return row

    def id(self, name: str) -> str:
        """The id of the display of a name."""
        return self.row(name).id

    def display_named(self, name: str) -> Any:
        """The display of a name, with its properties."""
        return self.row(name).display

    def stream_scans(self, topic: str, hz: float, frame: str = "map") -> None:
        """Publish scans for as long as rates are measured, and a bit."""
        for _ in range(round(4 * hz)):
            self.pass_time(1 / hz)
            self.publish(topic, SCAN, {"header": header(frame, self.source.now)})
            self.turn()

    def published(self) -> list[tuple[str, Any]]:
        """Topic and message of all that tools and panels published."""
        return [(each.topic, message) for each, message in self._graph.published]

    def values(self, path: str) -> list[Any]:
        """The values of a property of all displays."""
        return [attrgetter(path)(row.display) for row in self.rows]

    def history(self) -> UndoHistory:
        """Return the steps that can be undone and redone."""
        return self.viewer.get(UndoFeature).history()

    def view(self, browser: int) -> Any:
        """The view of a browser."""
        return self.viewer.get(ViewsPart).current()[browser]

    def outline(self) -> str:
        """The names of the displays in their order, as "a g(b c) d" with a group g."""
        return " ".join(map(_outline, self.viewer.config().displays))

    def _note_state(self) -> None:
        super()._note_state()
        del self.states[:-1]
        if self._pages is not None:
            self._pages.update()

    def _enqueue(self, command: Command, sender: Sender) -> Future[str]:
        answer = self.viewer.enqueue(command, sender)
        if sender is not PROGRAM and not isinstance(command, NOT_CLICKED):
            answer.add_done_callback(lambda _: self._note(command, sender))
        return answer

    def _note(self, command: Command, sender: Sender) -> None:
        self.commands.append(command)
        self.senders.append(sender)


def _outline(item: Item) -> str:
    if isinstance(item, Branch):
        return f"{item.group.name}({' '.join(map(_outline, item.displays))})"
    return item.name
