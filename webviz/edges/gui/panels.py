"""The panels in every browser, as tabs of one panel of viser's."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import viser

from webviz.api.declared import make
from webviz.api.panel import Panel
from webviz.api.registry import broken_types, plugin_types
from webviz.edges.gui.answers import Answers
from webviz.edges.gui.file_names import NAME, title_of
from webviz.edges.gui.style import failure_html, panel_style
from webviz.edges.gui.text import escape, plain
from webviz.edges.gui.ui import TabUi
from webviz.engine.commands import Command, Sender
from webviz.engine.pipeline.guard import Guard
from webviz.engine.state import File, State

WIDTH_PX = 360


class Panels:
    """All panels of the registry; those of files come and go with it.

    All browsers share them. What people do becomes commands; what they see comes from `update`.

    Args:
        server: where the panels appear.
        enqueue: takes commands and who sends them; called from viser's threads, must not block.
    """

    def __init__(
        self, server: viser.ViserServer, enqueue: Callable[[Command, Sender], object]
    ) -> None:
        self._server = server
        self._gui = gui = server.gui
        self._enqueue = enqueue
        self._title = ""
        gui.main_panel.dock_left()
        gui.main_panel.set_width(WIDTH_PX)
        self._answers = Answers(server)
        self._style = gui.add_html("")
        self._call(title_of(File()))
        self._group = gui.add_tab_group()
        self._tabs: dict[str, _Tab] = {}
        self._follow_registry()
        for name, reason in broken_types(Panel).items():
            with self._group.add_tab(plain(name)):
                gui.add_html(failure_html(reason))

    def update(self, state: State) -> None:
        """Show the viewer as it is; sends only what differs from what is shown.

        To be called by the frame loop some times a second, and after commands: edits settle with
        time.
        """
        self._call(title_of(state.file, state.clock.is_paused))
        self._follow_registry()
        for tab in self._tabs.values():
            tab.update(state)
        self._answers.update(state.answer)

    def _call(self, title: str) -> None:
        """Give the panel and the page a title."""
        if title != self._title:
            self._title = title
            self._gui.set_panel_label(title)
            self._style.content = panel_style(
                escape(title if title.startswith(NAME) else f"{title} · {NAME}")
            )

    def _follow_registry(self) -> None:
        types = plugin_types(Panel)
        for name in [n for n, tab in self._tabs.items() if types.get(n) is not tab.type]:
            self._tabs.pop(name).remove()
        for name in sorted(types.keys() - self._tabs.keys(), key=lambda n: (types[n].place, n)):
            self._tabs[name] = _Tab(self._server, self._group, name, types[name], self._send)

    def _send(self, command: Any, browser: int | None = None) -> None:
        self._enqueue(command, Sender(browser))


class _Tab:
    """One panel in its tab.

    Args:
        server: where the tab is.
        group: the tabs.
        name: of the panel in the registry.
        type_: the panel.
        send: see `webviz.api.panel.Send`.
    """

    def __init__(
        self,
        server: viser.ViserServer,
        group: viser.GuiTabGroupHandle,
        name: str,
        type_: type[Panel],
        send: Callable[..., None],
    ) -> None:
        self.type = type_
        title = plain(type_.title or name)
        self._guard = Guard(f"The panel {title}", strict=False)
        self._told = ""
        self._panel: Panel | None = None
        self._tab = group.add_tab(title)
        with self._tab:
            self._ui = TabUi(server, title)
            self._guard("build", self._build, send)
            self._ui.arrange()

    def update(self, state: State) -> None:
        """Let the panel show the viewer, and tell what it raises."""
        if self._panel is not None:
            self._guard("show", self._panel.show, state)
        sentence = next(iter(self._guard.crashes.values()), "")
        if sentence != self._told:
            self._told = sentence
            with self._tab:
                self._ui.fail(sentence)

    def remove(self) -> None:
        """Take the tab away."""
        self._ui.close()
        self._tab.remove()

    def _build(self, send: Callable[..., None]) -> None:
        panel = make(self.type, {})
        panel.build(self._ui, send)
        self._panel = panel
