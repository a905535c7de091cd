"""Panels of plug-ins: each records its widgets, and pages draw them in a tab of its own."""

from __future__ import annotations

import contextlib
import logging
import queue
import threading
from collections.abc import Callable, Mapping, Sequence, Set
from concurrent.futures import Future
from typing import Any, ClassVar

import msgspec

from webviz.api.display import Display
from webviz.api.errors import Error
from webviz.api.modules import module_texts
from webviz.api.panel import Panel
from webviz.api.properties import properties_of
from webviz.api.registry import broken_types, plugin_types
from webviz.api.roles import Role
from webviz.api.tool import Tool
from webviz.engine.commands import PageCommand, Sender
from webviz.engine.error_boundary import ErrorBoundary
from webviz.engine.feature import command, store
from webviz.engine.forms import Form, form, values_of
from webviz.engine.parts import visibility
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.parts.panels import PanelsPart
from webviz.engine.parts.part import PartContext
from webviz.engine.state import PanelTab
from webviz.engine.store import PageStore
from webviz.page.dispatcher import Dispatcher, PageFeature
from webviz.page.page_request import PageRequest
from webviz.page.recorded_ui import RecordedUi
from webviz.page.widgets import Widget, clean

log = logging.getLogger("webviz")

MAX_WAITING = 16
"""Actions of one panel that wait for one that takes long."""
_SHARED = ("name",)
"""Properties of all panels, which their tab does not show."""


class PanelType(msgspec.Struct, frozen=True):
    """A type of panels that can be added.

    Args:
        type, title: its names for commands and for people.
        about: one line of what it shows.
        icon, opens: see `webviz.api.panel.Panel`.
    """

    type: str
    title: str
    about: str
    icon: str
    opens: str


class PanelsStore(PageStore, frozen=True):
    """The panels of plug-ins.

    Args:
        titles: by name.
        order: the names from left to right.
        types: that can be added.
    """

    spread: ClassVar = {"titles": ""}

    titles: Mapping[str, str]
    order: Sequence[str] = msgspec.field(name="/order")
    types: Sequence[PanelType] = msgspec.field(name="/types")


class PanelStore(PageStore, frozen=True):
    """The widgets of a panel.

    Args:
        widgets: by id, see `webviz.page.widgets`; the parts of a widget have its id with
            a slash and theirs.
        order: the ids.
        failure: a sentence or "".
    """

    spread: ClassVar = {"widgets": ""}

    widgets: Mapping[str, Mapping[str, Any]]
    order: Sequence[str] = msgspec.field(name="/order")
    failure: str = msgspec.field(name="/failure")


class PanelPropertiesStore(PageStore, frozen=True):
    """Properties of a panel, as the store `tool` has them of a tool.

    Args:
        id: for commands.
        type: its name in the registry.
        declared, values: of the properties.
        offered: the names of displays that get a switch, with their types, by property.
    """

    spread: ClassVar = {"values": "value.", "offered": "offered."}

    id: str
    type: str
    declared: Form
    values: Mapping[str, Any]
    offered: Mapping[str, Mapping[str, str]]


class PanelCommand(msgspec.Struct, frozen=True):
    """A command of a panel.

    Args:
        panel, widget: for `Use`.
        label: of the command.
        key: that runs it, "" for none.
    """

    panel: str
    widget: str
    label: str
    key: str


class PanelCommandsStore(PageStore, frozen=True):
    """The commands of all panels, by panel and widget with a slash between."""

    spread: ClassVar = {"commands": ""}

    commands: Mapping[str, PanelCommand]


class ModulesStore(PageStore, frozen=True):
    """The texts of all modules by kind and name of their plug-ins, such as "tool Lasso".

    Those of a plug-in are by file name, each after those that it imports.
    """

    spread: ClassVar = {"modules": ""}

    modules: Mapping[str, Mapping[str, str]]


class PluginPanels(PageFeature):
    """The panels of plug-ins, each in a tab named after its type.

    All browsers share them. What browsers do runs in a thread of each panel, so that no act stops
    the viewer or another panel.
    """

    name = "Plug-in panels"
    module = "panels.js"

    def __init__(self, context: PartContext) -> None:
        super().__init__(context)
        self._dispatcher: Dispatcher | None = None
        self._tabs: dict[str, _Tab] = {}
        self._tab_rows: Sequence[PanelTab] = ()
        self._broken = broken_types(Panel)

    def attach(self, dispatcher: Dispatcher) -> None:
        """Begin to build panels: there are pages that show them."""
        self._dispatcher = dispatcher

    def update(self) -> None:
        """Build new panels, and end those that are gone."""
        if self._dispatcher is None:
            return
        self._tab_rows = self.context.get(PanelsPart).tabs()
        panels = {tab.tab: tab.panel for tab in self._tab_rows}
        for name in [n for n, tab in self._tabs.items() if panels.get(n) is not tab.panel]:
            self._tabs.pop(name).close()
        for name in panels.keys() - self._tabs.keys():
            self._tabs[name] = _Tab(name, panels[name], self._send)

    def watched(self, stores: Set[str]) -> None:
        """Let the panels read that pages have open, and no others."""
        opened = (store.partition(":")[2] for store in stores if store.startswith("panel:"))
        self.context.get(PanelsPart).open_panels(frozenset(opened))

    # Stores

    @store()
    def panels(self, argument: str) -> PanelsStore:
        """Return the panels of plug-ins."""
        titles = {name: tab.title for name, tab in self._tabs.items()}
        broken = {name: clean(name) for name in self._broken}
        order = [*(tab.tab for tab in self._tab_rows), *self._broken]
        return PanelsStore(titles | broken, order, _types())

    @store()
    def panel(self, name: str) -> PanelStore:
        """Let a panel show the viewer, and return its widgets."""
        tab = self._tabs.get(name)
        if tab is None:
            return PanelStore({}, [], self._broken.get(name, ""))
        if not (self.context.player.is_seeking and tab.is_shown):  # on the way, it lacks messages
            tab.show(self.context.get(PanelsPart))
        widgets = dict(tab.ui.widgets)
        values = {id_: widget.values for id_, widget in widgets.items()}
        parts = {
            f"{id_}/{name}": part
            for id_, widget in widgets.items()
            for name, part in widget.parts.items()
        }
        return PanelStore(values | parts, list(widgets), tab.failure)

    @store(name="panel_properties")
    def properties(self, name: str) -> PanelPropertiesStore | None:
        """Return the properties of a panel; None if it is gone."""
        chosen = next((tab for tab in self._tab_rows if tab.tab == name), None)
        if chosen is None:
            return None
        cls, own = type(chosen.panel), values_of(chosen.panel, _SHARED)
        switches = [each for each in properties_of(cls) if each.widget == "displays"]
        names = visibility.names(self.context.get(DisplaysPart).rows) if switches else {}
        offered = {each.path: names for each in switches}
        return PanelPropertiesStore(chosen.id, cls.__name__, form(cls, _SHARED), own, offered)

    @store()
    def commands(self, argument: str) -> PanelCommandsStore:
        """Return the commands of all panels."""
        return PanelCommandsStore(
            {
                f"{name}/{id_}": PanelCommand(name, id_, **command.values)
                for name, tab in self._tabs.items()
                for id_, command in dict(tab.ui.commands).items()
            }
        )

    @store(of=lambda panels: [plugin_types(base) for base in (Display, Tool, Panel)])
    def modules(self, argument: str) -> ModulesStore:
        """Return the modules of plug-ins for the page, of panels, tools and displays."""
        return ModulesStore(
            {
                f"{base.kind} {name}": module_texts(cls)
                for base in (Display, Tool, Panel)
                for name, cls in plugin_types(base).items()
                if cls.module
            }
        )

    @command(Role.OPERATOR, PageCommand)
    def use_widget(
        self, panel: str, widget: str, page_request: PageRequest, value: bool | str | None = None
    ) -> None:
        """Use a widget in a plug-in's panel.

        Args:
            panel: its name in the registry.
            widget: its id.
            value: what was entered, None for a button.
        """

        def act(tab: _Tab, used: Widget) -> None:
            if problem := tab.use(used, value, page_request.browser):
                page_request.refuse(problem)
            else:
                page_request.answer()

        tab = self._tabs.get(panel)
        used = tab.ui.find(widget) if tab else None
        if tab is None or used is None:
            page_request.refuse("Failed: this panel has changed.")
        elif not tab.hands.do(lambda: act(tab, used)):
            page_request.refuse(f"Failed: the panel {tab.title} is busy.")

    def close(self) -> None:
        """End all panels."""
        for tab in self._tabs.values():
            tab.close()

    def _send(self, command: Any, browser: int | None = None) -> None:
        if self._dispatcher is not None:
            result = self._dispatcher.enqueue(command, Sender(browser))
            result.add_done_callback(_note_refusal)


def _types() -> list[PanelType]:
    """Return the types of panels, in the order of their titles."""
    types = [
        PanelType(name, clean(cls.title or name), _about(cls), cls.icon, cls.opens)
        for name, cls in plugin_types(Panel).items()
    ]
    return sorted(types, key=lambda each: each.title.casefold())


def _about(cls: type[Panel]) -> str:
    """Return the first line of the docstring, without the full stop."""
    return clean((cls.__doc__ or "").strip().partition("\n")[0].removesuffix("."))


def _note_refusal(answer: Future[str]) -> None:
    if not answer.cancelled() and (error := answer.exception()) is not None:
        log.warning("A panel sent a command that was refused: %s", error)


class _Tab:
    """One panel in its tab.

    Args:
        name: of the tab.
        panel: not built yet.
        send: see `webviz.api.panel.Send`.
    """

    def __init__(self, name: str, panel: Panel, send: Callable[..., None]) -> None:
        self.panel = panel
        self.title = clean(panel.name)
        self.ui = RecordedUi()
        self.hands = _Hands(f"webviz-panel-{name}")
        self.failure = ""
        self._boundary = ErrorBoundary(f"The panel {self.title}", strict=False)
        self._action_boundary = ErrorBoundary(f"The panel {self.title}", strict=False)
        self._is_built = self.is_shown = False
        self._boundary("build", self._build, send)

    def show(self, panels: PanelsPart) -> None:
        """Let the panel show the viewer, and note what it raises."""
        if self._is_built:
            self._boundary("show", panels.show, self.panel)
            self.is_shown = True
        self.failure = next(iter(self._boundary.crashes.values()), "")

    def use(self, widget: Widget, value: Any, browser: int) -> str:
        """Do what a browser did; returns what went wrong, a sentence or ""."""
        try:
            widget.use(value, browser)
        except Error as error:  # what the user can put right
            return str(error)
        except (Exception, SystemExit) as error:  # a plug-in may raise anything
            return self._action_boundary.note("act", error)
        return ""

    def close(self) -> None:
        """End it."""
        self.hands.close()

    def _build(self, send: Callable[..., None]) -> None:
        self.panel.build(self.ui, send)
        self._is_built = True


class _Hands:
    """Does what browsers ask of one panel, one after the other, in a thread of its own.

    Args:
        name: of the thread.
    """

    def __init__(self, name: str) -> None:
        self._name = name
        self._waiting: queue.Queue[Callable[[], object] | None] = queue.Queue(MAX_WAITING)
        self._thread: threading.Thread | None = None

    def do(self, act: Callable[[], object]) -> bool:
        """Do something as soon as possible; False if too much is waiting. From one thread only."""
        try:
            self._waiting.put_nowait(act)
        except queue.Full:
            return False
        if self._thread is None:
            self._thread = threading.Thread(target=self._run, name=self._name, daemon=True)
            self._thread.start()
        return True

    def close(self) -> None:
        """Forget what waits, and end when what is under way is done."""
        with contextlib.suppress(queue.Empty):
            while True:
                self._waiting.get_nowait()
        self._waiting.put_nowait(None)

    def _run(self) -> None:
        while (act := self._waiting.get()) is not None:
            act()
