"""RViz's panel "Views": what a browser looks at, and the views that are saved.

All browsers share the saved views and see the same buttons, which act in the browser in which
they are clicked. What a browser looks at is its own, and so are the widgets that show it.
"""

from __future__ import annotations

import functools
import itertools

import viser

from webviz.api.panel import Panel, Send, Ui
from webviz.api.views import View, type_of
from webviz.edges.gui.style import row_style
from webviz.edges.gui.text import plain
from webviz.edges.gui.ui import browser_of
from webviz.edges.gui.view_editor import ViewEditor
from webviz.engine.commands import RemoveView, ResetView, SaveView, ShowView, StartWithView
from webviz.engine.state import State

NAME = "View"
"""Of a saved view that nobody named, before its number."""

SAVE, SHOW = (16, 8), (17, 7)
"""Columns of the line in which a view is named, and of one that shows it."""


class Views(Panel):
    """What a browser looks at, and the views that are saved."""

    place = 20

    def build(self, ui: Ui, send: Send) -> None:
        """The view of each browser, and the saved ones for all."""
        self._server: viser.ViserServer = ui.viser
        self._gui = gui = self._server.gui
        self._send = send
        self._editors: dict[int, ViewEditor] = {}
        self._saved: dict[str, View] = {}
        self._lines: list[viser.GuiButtonHandle] = []
        with gui.add_folder(None):
            gui.add_html(row_style("view", (12, 12)))
            zero = gui.add_button("Zero", color="gray", hint="Reset this view (Z)")
            hint = "Make this the default view of new browsers and pictures."
            start = gui.add_button("Start with this", color="gray", hint=hint)
        zero.on_click(lambda event: self._zero(browser_of(event)))
        start.on_click(lambda event: self._start_with(browser_of(event)))
        self._own = gui.add_folder(None)
        self._list = gui.add_folder("Saved views")
        with self._list:
            self._style = gui.add_html(row_style("saved-views", SAVE))
            self._name = gui.add_text("", "", hint="Name of the view to save.")
            save = gui.add_button("Save this", color="gray", hint="Save the current view.")
            save.on_click(self._save)
        ui.command("Zero view", self._zero, key="Z")

    def show(self, state: State) -> None:
        """Show the viewer as it is."""
        clients = self._server.get_clients()
        for id in self._editors.keys() - clients.keys():
            del self._editors[id]  # viser clears what a browser had
        for id, view in state.views.items():
            if id in clients:
                if id not in self._editors:
                    self._editors[id] = ViewEditor(clients[id], self._own, view, self._send)
                self._editors[id].update(view, state.frames)
        if state.settings.views != self._saved:
            self._saved = dict(state.settings.views)
            with self._server.atomic():
                self._show_saved()

    def _zero(self, browser: int | None) -> None:
        self._send(ResetView(), browser)

    def _start_with(self, browser: int | None) -> None:
        self._send(StartWithView(), browser)

    def _show_saved(self) -> None:
        for line in self._lines:
            line.remove()
        self._lines = []
        self._style.content = row_style("saved-views", SAVE + SHOW * len(self._saved))
        with self._list:
            for name, view in self._saved.items():
                hint = f"Switch to this view: {type_of(view)}"
                show = self._gui.add_button(plain(name), color="gray", hint=hint)
                remove = self._gui.add_button("Remove", color="gray", hint="Remove this view.")
                show.on_click(functools.partial(self._look, name))
                remove.on_click(functools.partial(self._remove, name))
                self._lines += [show, remove]

    def _look(self, name: str, event: viser.GuiEvent[viser.GuiButtonHandle]) -> None:
        self._send(ShowView(name), browser_of(event))

    def _remove(self, name: str, event: viser.GuiEvent[viser.GuiButtonHandle]) -> None:
        self._send(RemoveView(name), browser_of(event))

    def _save(self, event: viser.GuiEvent[viser.GuiButtonHandle]) -> None:
        names = (f"{NAME} {number}" for number in itertools.count(1))
        free = next(name for name in names if name not in self._saved)
        name = self._name.value.strip() or free
        self._name.value = ""
        self._send(SaveView(name), browser_of(event))
