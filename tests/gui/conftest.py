"""A server, a panel, a stand-in for the frame loop, and real browsers that show the panel."""

from __future__ import annotations

import contextlib
import queue
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Annotated, Any, Literal

import msgspec
import playwright.sync_api as playwright
import pytest
import viser

from webviz.api.declared import Color, Prop, Topic, set_property
from webviz.api.display import Display
from webviz.api.ports import Input
from webviz.api.status import Status
from webviz.edges.gui import Panels, take_typed
from webviz.edges.scene import on_typed, open_server
from webviz.edges.scene.adapter import Adapter
from webviz.engine.commands import Command, Refresh, Sender, SetProperty
from webviz.engine.state import Row, State
from webviz.shell.pictures.browser_scripts import HOLD

WIDTH, HEIGHT = 700, 900
"""Of a tab in pixels."""


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
    """Does what the frame loop does for the panel.

    Args:
        server: where the panel appears.
    """

    def __init__(self, server: viser.ViserServer) -> None:
        self.commands: list[Command] = []
        self.senders: list[Sender] = []
        self.state = State()
        self._queue: queue.SimpleQueue[tuple[Command, Sender]] = queue.SimpleQueue()
        self.panel = Panels(server, lambda *request: self._queue.put(request))

    def show(self, *rows: Row, **changes: Any) -> None:
        """Show these displays."""
        self.state = replace(self.state, rows=rows, **changes)
        self.panel.update(self.state)

    def is_asked(self) -> bool:
        """Whether something was enqueued."""
        return not self._queue.empty()

    def drain(self) -> None:
        """Collect what was enqueued, and answer what only asks for a new state."""
        while not self._queue.empty():
            command, sender = self._queue.get()
            if isinstance(command, Refresh):
                self.panel.update(self.state)
            else:
                self.commands.append(command)
                self.senders.append(sender)

    def turn(self) -> None:
        """Obey the property changes that are valid, and update the panel."""
        done = len(self.commands)
        self.drain()
        displays = {row.id: row.display for row in self.state.rows}
        for command in self.commands[done:]:
            display = displays.get(command.display) if isinstance(command, SetProperty) else None
            if isinstance(command, SetProperty) and display is not None:
                try:
                    set_property(display, command.path, command.value)
                except msgspec.ValidationError:
                    continue
        self.panel.update(self.state)


class Tab:
    """One browser tab that shows the panel and whose edits count."""

    def __init__(self, page: playwright.Page, server: viser.ViserServer, loop: Loop) -> None:
        self.page = page
        self.loop = loop
        self.errors: list[str] = []
        self.frames_received = 0
        page.on("pageerror", lambda error: self.errors.append(str(error)))
        page.on("console", self._read_console)
        page.on("dialog", self._dismiss)
        page.on("websocket", self._listen)
        # viser ignores the edits of a browser that has not told its camera yet.
        known = len(server.get_clients())
        page.goto(f"http://127.0.0.1:{server.get_port()}/?fixedDpr=1")
        page.get_by_text("Fixed Frame", exact=True).wait_for()
        self.wait_for(lambda: len(server.get_clients()) > known)
        page.evaluate(
            HOLD
        )  # to draw the scene, which no test looks at, would take most of the time

    def field(self, label: str) -> playwright.Locator:
        """The input with a label on its left."""
        text = self.page.locator(f"label:text-is('{label}')")
        return text.locator("xpath=ancestor::div[2]//*[self::input or self::textarea]").first

    def fill(self, label: str, text: str) -> None:
        """Enter something, at most as fast as the page takes it."""
        self.field(label).fill(text)
        self.pause()

    def boxes(self) -> playwright.Locator:
        """The check boxes in the list of displays."""
        return self.page.locator(":has(> div > .webviz-list) input[type=checkbox]")

    def names(self) -> list[str]:
        """The texts in the list of displays."""
        return self.page.locator(":has(> div > .webviz-list) button").all_inner_texts()

    def click(self, name: str) -> None:
        """Click on a button of the panel, and let the loop do what it is asked thereby."""
        self.loop.drain()
        self.page.get_by_role("button", name=name, exact=True).click()
        self.wait_for(self.loop.is_asked)
        self.loop.drain()

    def show_tab(self, name: str) -> None:
        """Open a tab of the panel."""
        self.page.get_by_text(name, exact=True).first.click()

    def dialog_button(self, name: str) -> playwright.Locator:
        """A button of the dialog that is open."""
        return self.page.get_by_role("dialog").get_by_role("button", name=name, exact=True)

    def dialog_labels(self) -> list[str]:
        """The labels of check boxes in the dialog that is open."""
        self.loop.drain()
        return self.page.locator(":has(> div > .webviz-picks) label").all_inner_texts()

    def check(self, label: str) -> None:
        """Check a box by its label."""
        self.page.get_by_label(label, exact=True).check()
        self.pause()

    def uncheck(self, label: str) -> None:
        """Clear a box by its label."""
        self.page.get_by_label(label, exact=True).uncheck()
        self.pause()

    def pause(self) -> None:
        """Let the page take the next edit: it takes one in 50 ms, by its own clock."""
        self.page.evaluate("() => new Promise((done) => setTimeout(done, 60))")

    def text(self) -> str:
        """All that can be read on the page."""
        return self.page.locator("body").inner_text()

    def wait_for(self, condition: Callable[[], bool], timeout: float = 60.0) -> None:
        """Wait until a condition holds while the page runs."""
        for _ in range(int(timeout / 0.02)):
            if condition():
                return
            self.page.wait_for_timeout(20)
        raise AssertionError("timed out")

    def _dismiss(self, dialog: playwright.Dialog) -> None:
        self.errors.append(f"a script ran: {dialog.message}")
        dialog.dismiss()

    def _read_console(self, message: playwright.ConsoleMessage) -> None:
        if message.type == "error":
            self.errors.append(message.text)

    def _listen(self, socket: Any) -> None:
        """Count what viser sends; the channel has a sign of life every second."""
        if not socket.url.endswith("/channel"):
            socket.on("framereceived", self._count)

    def _count(self, _: object) -> None:
        self.frames_received += 1


@pytest.fixture(scope="module")
def page_server() -> Iterator[viser.ViserServer]:
    """One server for the tests of a module, and thereby for its tab."""
    server = open_server(port=0)
    on_typed(Adapter(server), take_typed)
    yield server
    server.stop()


@pytest.fixture
def server(page_server: viser.ViserServer) -> Iterator[viser.ViserServer]:
    """A server without a panel."""
    yield page_server
    remove_panel(page_server)


@pytest.fixture
def loop(server: viser.ViserServer) -> Loop:
    return Loop(server)


@pytest.fixture
def open_tab(
    browser: playwright.Browser, server: viser.ViserServer, loop: Loop
) -> Iterator[Callable[..., Tab]]:
    """Opens tabs, each in a browser session of its own; in the end none has seen an error."""
    tabs: list[Tab] = []

    def open_tab(width: int = WIDTH, height: int = HEIGHT, **options: Any) -> Tab:
        tabs.append(Tab(open_page(browser, width, height, **options), server, loop))
        return tabs[-1]

    yield open_tab
    errors = [error for tab in tabs for error in tab.errors]
    for tab in tabs:
        tab.page.context.close()
    assert errors == []


@pytest.fixture(scope="module")
def lasting_tabs() -> Iterator[list[Tab]]:
    """The tab of a module once it is open: that takes two seconds of a processor."""
    tabs: list[Tab] = []
    yield tabs
    for tab in tabs:
        tab.page.context.close()


@pytest.fixture
def tab(
    browser: playwright.Browser, server: viser.ViserServer, loop: Loop, lasting_tabs: list[Tab]
) -> Iterator[Tab]:
    """A tab with a new panel; its errors, as those of `open_tab`, fail the test."""
    tab = lasting_tabs.pop() if lasting_tabs else Tab(open_page(browser), server, loop)
    tab.loop = loop
    with contextlib.ExitStack() as unless_clean:
        unless_clean.callback(tab.page.context.close)
        label = tab.page.get_by_text("Fixed Frame", exact=True)
        label.wait_for()
        yield tab
        assert tab.errors == []
        remove_panel(server)
        for rest in (label, tab.page.get_by_role("dialog")):
            rest.wait_for(state="detached")
        unless_clean.pop_all()
        lasting_tabs.append(tab)


def remove_panel(server: viser.ViserServer) -> None:
    """Take away what every browser shows, and what only some of them do."""
    for owner in (server, *server.get_clients().values()):
        owner.gui.reset()


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
        return Row(id_, "Everything", display, display.name, statuses or {})

    return make_row
