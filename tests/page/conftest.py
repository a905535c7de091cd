"""A server, its pages, a stand-in for the frame loop, and real browsers."""

from __future__ import annotations

import queue
from collections.abc import Callable, Iterator, Mapping, Set
from concurrent.futures import Future
from contextlib import contextmanager
from typing import Annotated, Any, Literal

import msgspec
import playwright.sync_api as playwright
import pytest
from msgspec.structs import replace
from pages import COARSE

from tests.support.given_parts import GivenParts
from tests.support.stand_ins import stand_ins
from webviz.api.declared import Color, Prop, Topic, set_property
from webviz.api.display import Display, Input
from webviz.api.status import Status
from webviz.api.vehicle import Velocity
from webviz.commands import (
    AddDisplay,
    DuplicateDisplay,
    InspectSelections,
    OpenPanels,
    Refresh,
    SetProperty,
)
from webviz.engine.commands import Command, Sender
from webviz.engine.driving import DrivingAnswer
from webviz.engine.feature import Feature, store
from webviz.engine.state import Row, State
from webviz.features.black_box.saved import BlackBoxStore, black_box_store
from webviz.features.latency import LatencyStore
from webviz.features.layouts import LayoutStore, layout_store
from webviz.features.recording import RecordingStore, recording_store
from webviz.features.what_if import WhatIfStore
from webviz.page.pages import Pages
from webviz.scene import open_server
from webviz.scene.server import Server
from webviz.server.access.access import Access

WIDTH, HEIGHT = 900, 800
"""Width of a tab in pixels."""

TIDY = """() => {
  document.querySelectorAll("#bench").forEach((one) => one.remove());
  document.querySelectorAll(".wv-toast [aria-label=Dismiss]").forEach((one) => one.click());
  document.activeElement?.blur();
  localStorage.clear();
}"""
"""Removes what tests put beside the panels, and forgets widths and folds."""

NOT_CLICKED = (InspectSelections, OpenPanels, Refresh)
"""Commands that follow from what pages watch."""

CATCH_UP = """async () => {
  const { on, send } = await import("webviz/channel.js");
  const answered = new Promise((resolve) => on("Pong", resolve));
  send({ type: "Ping" });
  await answered;
}"""
"""Returns when the page shows what the server has sent before."""


class Arrow(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    length: Annotated[float, Prop(gt=0, unit="m")] = 0.3


class Everything(Display):
    """A display with one property of each kind."""

    topic: Annotated[Topic, Input("sensor_msgs/msg/LaserScan")] = Topic("/scan")
    frame: Annotated[str, Prop(widget="frame")] = "<Fixed Frame>"
    size: Annotated[float, Prop(gt=0, unit="m", help="Edge of each point.")] = 0.01
    alpha: Annotated[float, Prop(ge=0, le=1)] = 1.0
    count: Annotated[int, Prop(ge=1)] = 3
    style: Literal["Points", "Flat Squares", "Boxes"] = "Points"
    edge: Annotated[float, Prop(gt=0, when=("style", "Boxes"))] = 0.5
    color: Color = (255, 25, 0)
    filled: bool = True
    channel: str = "intensity"
    offset: tuple[float, float, float] = (0.0, 0.5, 0.0)
    prefixes: list[str] = msgspec.field(default_factory=list)
    shown: dict[str, bool] = msgspec.field(default_factory=dict)
    arrow: Arrow = Arrow()


class Loop:
    """Does what the frame loop does for the pages.

    Args:
        server: of the pages.
        access: knows the tokens; None if none are asked for.
    """

    def __init__(self, server: Server, access: Access | None = None) -> None:
        self.commands: list[Command] = []
        self.senders: list[Sender] = []
        self.state = State()
        self.answer: str | Exception = ""
        """Answer to all commands."""
        self.made = ""
        """The id that commands answer with which make a display."""
        self.steered: list[tuple[str, int, Velocity | None]] = []
        """The set-points of vehicles."""
        self.controller = DrivingAnswer()
        """Answer to all commands."""
        self._queue: queue.SimpleQueue[tuple[Command, Sender, Future[str]]] = queue.SimpleQueue()
        self.of_features: dict[str, Any] = {}
        """Public fields of features."""
        self.watched: Set[str] = set()
        """Stores of features that pages watch."""
        self._given = GivenParts()
        own = [ShownFeatures(self), *stand_ins(self._field, self._steer, self._note)]
        self.features = [*own, *self._given.features]
        parts = [*own, *self._given.parts]
        self.pages = Pages(server.channel, self._enqueue, access, parts=parts)

    def _enqueue(self, command: Command, sender: Sender) -> Future[str]:
        answer: Future[str] = Future()
        self._queue.put((command, sender, answer))
        return answer

    def _steer(self, tool: str, browser: int, share: Velocity, seen: float | None) -> DrivingAnswer:
        self.steered.append((tool, browser, None if seen is None else share))
        return self.controller

    def show(self, *rows: Row, **changes: Any) -> None:
        """Show these displays."""
        self.change(rows=rows, **changes)
        self._update()

    def change(self, **changes: Any) -> None:
        """Change fields of the state, and public ones of features, from the next turn on."""
        own = {name: value for name, value in changes.items() if name in State.__struct_fields__}
        self.of_features |= {name: changes[name] for name in changes.keys() - own.keys()}
        self.state = replace(self.state, **own, more=dict(self.of_features))

    def turn(self) -> None:
        """Collect the commands, obey the property changes that are valid, and update the pages."""
        while not self._queue.empty():
            command, sender, answer = self._queue.get()
            if not isinstance(command, NOT_CLICKED):
                self.commands.append(command)
                self.senders.append(sender)
            reply = self.answer
            if isinstance(command, SetProperty):
                displays = {row.id: row.display for row in self.state.rows if row.display}
                try:
                    set_property(displays[command.display], command.path, command.value)
                    self.state = replace(self.state, rows=tuple(map(_as_is, self.state.rows)))
                except msgspec.ValidationError as error:
                    reply = error
            if self.made and isinstance(command, AddDisplay | DuplicateDisplay):
                command.made(self.made)
            if isinstance(reply, Exception):
                answer.set_exception(reply)
            else:
                answer.set_result(reply)
        self._update()

    def _field(self, name: str, other: Any) -> Any:
        return self.of_features.get(name, other)

    def _note(self, command: Command) -> None:
        self._enqueue(command, Sender())

    def _update(self) -> None:
        self._given.show(self.state)
        for feature in self.features:
            feature.update()
        self.pages.update()


class ShownFeatures(Feature):
    """The stores of features, from what is given to the loop."""

    def __init__(self, loop: Loop) -> None:
        self._loop = loop

    def watched(self, stores: Set[str]) -> None:
        self._loop.watched = stores

    @store()
    def latency(self, argument: str) -> LatencyStore:
        return LatencyStore(self._loop.of_features.get("latencies", ()))

    @store()
    def layout(self, argument: str) -> LayoutStore:
        return layout_store(self._loop.state.settings, argument)

    @store()
    def what_if(self, argument: str) -> WhatIfStore | None:
        return self._loop.of_features.get("what_if")

    @store()
    def recording(self, argument: str) -> RecordingStore | None:
        given, bounds = self._loop.of_features, self._loop.state.settings.memory
        return recording_store(given.get("memory"), given.get("recording"), bounds)

    @store()
    def black_box(self, argument: str) -> BlackBoxStore | None:
        has_rules = bool(self._loop.state.settings.watch)
        return black_box_store(self._loop.of_features.get("black_box"), has_rules)


def _as_is(row: Row) -> Row:
    """A row with the name and the switch that its display has now."""
    display = row.display
    if display is None:
        return row
    changed = row.revision + 1  # the display is the same object
    return replace(row, name=display.name, enabled=display.enabled, revision=changed)


class Tab:
    """One browser tab; its errors fail the test.

    Args:
        page: an empty one.
        server: of the page to open.
        loop: of the server.
        resolution: pixels of the scene per pixel of the page.
        query: more of the address, as "&panel=topics".
    """

    def __init__(
        self,
        page: playwright.Page,
        server: Server,
        loop: Loop,
        resolution: float = COARSE,
        query: str = "",
    ) -> None:
        self.page = page
        self.loop = loop
        self.errors: list[str] = []
        page.on("pageerror", lambda error: self.errors.append(str(error)))
        page.on("console", self._read_console)
        page.on("dialog", self._dismiss)
        page.goto(f"http://127.0.0.1:{server.get_port()}/?fixedDpr={resolution}{query}")
        self.wait_for(lambda: page.locator("#webviz").count() > 0)

    def button(self, name: str) -> playwright.Locator:
        """A button by its exact name."""
        return self.page.get_by_role("button", name=name, exact=True)

    def show_tab(self, title: str) -> None:
        """Open a panel."""
        self.page.get_by_role("tab", name=title, exact=True).click()
        self.turn()

    def text(self) -> str:
        """All that can be read on the page."""
        return self.page.locator("#webviz").inner_text()

    def turn(self) -> None:
        """Let the page and the loop work for a moment."""
        self.page.wait_for_timeout(20)
        self.loop.turn()

    def wait_for(self, condition: Callable[[], object], timeout: float = 60.0) -> None:
        """Wait until a condition holds while the page and the loop run."""
        for _ in range(int(timeout / 0.02)):
            self.loop.turn()
            if condition():
                return
            self.page.wait_for_timeout(20)
        tabs = self.page.get_by_role("tab", include_hidden=True)
        told = tabs.evaluate_all("(all) => all.map((one) => [one.id, one.hidden, one.offsetWidth])")
        raise AssertionError(f"timed out; the tabs are {told}, and the page says {self.text()}")

    def wait_for_command(self, command: Command) -> None:
        """Wait until the newest command is this one."""
        self.wait_for(lambda: self.loop.commands[-1:] == [command])

    def _dismiss(self, dialog: playwright.Dialog) -> None:
        self.errors.append(f"a script ran: {dialog.message}")
        dialog.dismiss()

    def _read_console(self, message: playwright.ConsoleMessage) -> None:
        if message.type == "error":
            self.errors.append(message.text)


@pytest.fixture(scope="package")
def server() -> Iterator[Server]:
    """One server for all tests, and thereby for their tab."""
    server = open_server(port=0)
    yield server
    server.stop()


@pytest.fixture(scope="package")
def shared_loop(server: Server) -> Loop:
    """The loop of all tabs."""
    return Loop(server)


@pytest.fixture(scope="package")
def lasting(server: Server, browser: playwright.Browser, shared_loop: Loop) -> Iterator[Tab]:
    """The tab of all tests: to open one takes two seconds of a processor.

    A page that does nothing takes a thirtieth of a processor, so it does not stay for other tests.
    """
    tab = Tab(open_page(browser), server, shared_loop)
    yield tab
    tab.page.context.close()


@pytest.fixture(scope="module")
def tidy(lasting: Tab) -> Tab:
    """The tab as it was at first, whatever another module has done to it."""
    page = lasting.page
    page.set_viewport_size({"width": WIDTH, "height": HEIGHT})
    page.mouse.up()
    page.mouse.move(WIDTH - 1, HEIGHT - 1)
    page.keyboard.press("Escape")
    lasting.show_tab("Displays")
    lasting.loop.state = State()
    lasting.loop.of_features.clear()
    lasting.loop.turn()
    page.evaluate(CATCH_UP)  # images beside the scene would go while a test measures it
    page.evaluate(TIDY)
    return lasting


@pytest.fixture
def tab(tidy: Tab) -> Iterator[Tab]:
    """The tab with an empty viewer; it must not see an error."""
    lasting = tidy
    lasting.loop.state = State()
    lasting.loop.of_features.clear()
    lasting.loop.answer = lasting.loop.made = ""
    lasting.loop.turn()
    lasting.page.evaluate(CATCH_UP)  # else it may lose what a test before has left there
    lasting.loop.commands.clear()
    lasting.loop.senders.clear()
    yield lasting
    errors, lasting.errors = lasting.errors, []
    assert errors == []


@pytest.fixture
def loop(tab: Tab) -> Loop:
    """The loop of the tab."""
    return tab.loop


@contextmanager
def tabs_of(
    browser: playwright.Browser, server: Server, loop: Loop
) -> Iterator[Callable[..., Tab]]:
    """Open more tabs, each in a browser session of its own; they must not see an error."""
    tabs: list[Tab] = []

    def open_tab(
        width: int = WIDTH,
        height: int = HEIGHT,
        resolution: float = COARSE,
        query: str = "",
        **options: Any,
    ) -> Tab:
        page = open_page(browser, width, height, **options)
        tabs.append(Tab(page, server, loop, resolution, query))
        return tabs[-1]

    yield open_tab
    errors = [error for tab in tabs for error in tab.errors]
    for tab in tabs:
        tab.page.context.close()
    assert errors == []


@pytest.fixture
def open_tab(
    browser: playwright.Browser, server: Server, shared_loop: Loop
) -> Iterator[Callable[..., Tab]]:
    """Open more tabs for one test."""
    with tabs_of(browser, server, shared_loop) as open_tab:
        yield open_tab


@pytest.fixture(scope="module")
def open_lasting_tab(
    browser: playwright.Browser, server: Server, shared_loop: Loop
) -> Iterator[Callable[..., Tab]]:
    """Open more tabs for the tests of a module."""
    with tabs_of(browser, server, shared_loop) as open_tab:
        yield open_tab


def open_page(
    browser: playwright.Browser, width: int = WIDTH, height: int = HEIGHT, **options: Any
) -> playwright.Page:
    """An empty page in a browser session of its own."""
    return browser.new_context(viewport={"width": width, "height": height}, **options).new_page()


@pytest.fixture
def make_row() -> Callable[..., Row]:
    """A row with a display of every property; the name is its id unless given."""

    def make_row(
        id_: str, name: str = "", statuses: Mapping[str, Status] | None = None, **values: Any
    ) -> Row:
        display = Everything(name=name or id_, **values)
        statuses = statuses or {}
        return Row(id_, "Everything", display, display.name, statuses, enabled=display.enabled)

    return make_row
