"""Panels of plug-ins: each records its widgets, and pages draw them in a tab of its own."""

from __future__ import annotations

import contextlib
import queue
import threading
from collections.abc import Callable, Mapping
from typing import Any

from webviz.api.declared import make
from webviz.api.panel import Panel
from webviz.api.registry import broken_types, plugin_types
from webviz.edges.page.channel import Channel
from webviz.edges.page.messages import Done, Use
from webviz.edges.page.widgets import RecordedUi, Widget, clean
from webviz.engine.commands import Command, Sender
from webviz.engine.pipeline.guard import Guard
from webviz.engine.state import State

MAX_WAITING = 16
"""Acts of one panel that wait for one that takes long."""


class PluginPanels:
    """All panels of the registry; those of files come and go with it.

    All browsers share them. `update` is called by the frame loop; what browsers do runs in a thread
    of each panel, so that no act stops the viewer or another panel.

    Args:
        channel: to the pages.
        enqueue: takes commands, from any thread.
    """

    def __init__(self, channel: Channel, enqueue: Callable[[Command, Sender], object]) -> None:
        self._channel = channel
        self._enqueue = enqueue
        self._tabs: dict[str, _Tab] = {}
        self._broken = broken_types(Panel)
        channel.on(Use, self._use)

    def update(self, state: State) -> None:
        """Let every panel show the viewer."""
        types = plugin_types(Panel)
        for name in [n for n, tab in self._tabs.items() if types.get(n) is not tab.type]:
            self._tabs.pop(name).close()
        for name in types.keys() - self._tabs.keys():
            self._tabs[name] = _Tab(name, types[name], self._send)
        for tab in self._tabs.values():
            tab.update(state)

    # What stores hold, see `webviz.edges.page.content`

    def panels(self, state: State, _: str) -> Mapping[str, Any]:
        """Title by name, and "/order": the names from left to right."""
        order = sorted(self._tabs, key=lambda name: (self._tabs[name].type.place, name))
        titles = {name: tab.title for name, tab in self._tabs.items()}
        broken = {name: clean(name) for name in self._broken}
        return {**titles, **broken, "/order": [*order, *self._broken]}

    def panel(self, state: State, name: str) -> Mapping[str, Any]:
        """The widgets of a panel by id, "/order", and "/failure": a sentence or ""."""
        tab = self._tabs.get(name)
        if tab is None:
            return {"/order": [], "/failure": self._broken.get(name, "")}
        widgets = dict(tab.ui.widgets)
        values = {id_: widget.values for id_, widget in widgets.items()}
        return {**values, "/order": list(widgets), "/failure": tab.failure}

    def commands(self, state: State, _: str) -> Mapping[str, Any]:
        """The commands of all panels: panel, widget, label and key."""
        return {
            f"{name}/{id_}": {"panel": name, "widget": id_, **command.values}
            for name, tab in self._tabs.items()
            for id_, command in dict(tab.ui.commands).items()
        }

    # Called on the event loop

    def _use(self, browser: int, use: Use) -> None:
        def answer(text: str) -> None:
            level = "error" if text else "ok"
            self._channel.send(Done(use.number, level, text, ""), browser)

        tab = self._tabs.get(use.panel)
        widget = tab.ui.find(use.widget) if tab else None
        if tab is None or widget is None:
            answer("Not done: this panel has changed.")
        elif not tab.hands.do(lambda: answer(tab.use(widget, use.value, browser))):
            answer(f"Not done: the panel {tab.title} is busy.")

    def _send(self, command: Any, browser: int | None = None) -> None:
        self._enqueue(command, Sender(browser))


class _Tab:
    """One panel in its tab.

    Args:
        name: of the panel in the registry.
        type_: the panel.
        send: see `webviz.api.panel.Send`.
    """

    def __init__(self, name: str, type_: type[Panel], send: Callable[..., None]) -> None:
        self.type = type_
        self.title = clean(type_.title or name)
        self.ui = RecordedUi()
        self.hands = _Hands(f"webviz-panel-{name}")
        self.failure = ""
        self._guard = Guard(f"The panel {self.title}", strict=False)
        self._acts = Guard(f"The panel {self.title}", strict=False)
        self._panel: Panel | None = None
        self._guard("build", self._build, send)

    def update(self, state: State) -> None:
        """Let the panel show the viewer, and note what it raises."""
        if self._panel is not None:
            self._guard("show", self._panel.show, state)
        self.failure = next(iter(self._guard.crashes.values()), "")

    def use(self, widget: Widget, value: Any, browser: int) -> str:
        """Do what a browser did; returns what went wrong, a sentence or ""."""
        try:
            widget.use(value, browser)
        except (Exception, SystemExit) as error:  # a plug-in may raise anything
            return self._acts.note("act", error)
        return ""

    def close(self) -> None:
        """End it."""
        self.hands.close()

    def _build(self, send: Callable[..., None]) -> None:
        panel = make(self.type, {})
        panel.build(self.ui, send)
        self._panel = panel


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
