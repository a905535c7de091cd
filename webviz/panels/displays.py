"""RViz's panel "Displays": the file, global options, the list, the properties of one display."""

from __future__ import annotations

import viser

from webviz.api.panel import Panel, Send, Ui
from webviz.api.registry import display_types
from webviz.edges.gui.add_by_topic import AddByTopic
from webviz.edges.gui.dialogs import Dialogs
from webviz.edges.gui.display_list import DisplayList
from webviz.edges.gui.editor import Editor
from webviz.edges.gui.files import Files
from webviz.edges.gui.global_options import GlobalOptions
from webviz.edges.gui.selection import Selection
from webviz.edges.gui.style import WHOLE, row_style
from webviz.edges.gui.ui import browser_of
from webviz.engine.commands import (
    AddDisplay,
    DuplicateDisplay,
    FocusDisplay,
    Refresh,
    RemoveDisplay,
    Reset,
)
from webviz.engine.state import State


class Displays(Panel):
    """What is shown: the file, global options, the displays, and the properties of one."""

    place = 10

    def build(self, ui: Ui, send: Send) -> None:
        """The tab, the dialogs that it opens, and what the keyboard does to displays and files."""
        self._server: viser.ViserServer = ui.viser
        self._gui = gui = self._server.gui
        self._send = send
        self._dialogs = Dialogs(self._server, send)
        self._files = Files(self._dialogs, send)
        self.selection = Selection()
        self._editor: Editor | None = None
        self._box = gui.add_folder(None)
        with self._box:
            file_row, others, add_row = (4, 6, 4, 5, 5), (WHOLE, WHOLE), (12, 5, 7)
            gui.add_html(row_style("displays", (*file_row, *others, *add_row)))
            self._add_file_row(self._files)
            self._options = GlobalOptions(gui, send)
            self._list = DisplayList(gui, send, self._choose)
            self._type = gui.add_dropdown("", tuple(display_types()) or ("",))
            self._add_buttons()
        self._add_commands(ui)

    def show(self, state: State) -> None:
        """Show the viewer as it is."""
        self._files.update(state)
        self._options.update(state)
        if (types := tuple(display_types())) != self._type.options and types:
            self._type.options = types  # a plug-in brought some
        self.selection.follow(state.rows)
        self._list.update(state.rows, self.selection.id)
        self._edit(state)
        self._dialogs.update(state)

    def add_by_topic(self, browser: int | None) -> None:
        """Ask which of the live topics to show."""
        self._dialogs.open(
            browser, lambda client: AddByTopic(client, self._send, self.selection.expect_new)
        )

    def focus(self, browser: int | None) -> None:
        """Let a browser look at the selected display."""
        if self.selection.id is not None and browser is not None:
            self._send(FocusDisplay(self.selection.id), browser)

    def duplicate(self, browser: int | None) -> None:
        """Add a copy of the selected display, and select it."""
        if self.selection.id is not None:
            self.selection.expect_new()
            self._send(DuplicateDisplay(self.selection.id), browser)

    def remove(self, browser: int | None) -> None:
        """Remove the selected display."""
        if self.selection.id is not None:
            self._send(RemoveDisplay(self.selection.id), browser)

    def _add_file_row(self, files: Files) -> None:
        gui = self._gui
        save = gui.add_button("Save", color="gray", hint="Save the config to its file (Ctrl+S)")
        save_as = gui.add_button("Save as", color="gray", hint="Save as or download (Ctrl+Shift+S)")
        open_ = gui.add_button("Open", color="gray", hint="Open or upload a config (Ctrl+O)")
        image = gui.add_button("Image", color="gray", hint="Save a screenshot of your view.")
        reset = gui.add_button("Reset", color="gray", hint="Clear all transforms and messages (R)")
        save.on_click(lambda event: files.save(browser_of(event)))
        save_as.on_click(lambda event: files.save_as(browser_of(event)))
        open_.on_click(lambda event: files.open(browser_of(event)))
        image.on_click(lambda event: files.save_image(browser_of(event)))
        reset.on_click(lambda event: self._reset(browser_of(event)))

    def _add_buttons(self) -> None:
        gui = self._gui
        add = gui.add_button("Add", color="gray", hint="Add a display of this type.")
        by_topic = gui.add_button("By topic", color="gray", hint="Add displays for live topics.")
        add.on_click(lambda event: self._add(browser_of(event)))
        by_topic.on_click(lambda event: self.add_by_topic(browser_of(event)))

    def _add_commands(self, ui: Ui) -> None:
        """Keys and the palette.

        They are RViz's where a browser leaves them to a page. Not those of RViz that open a window,
        reload or close a tab in a browser (Ctrl+N, R, X), nor W, A, S, D, Q, E and arrows, which
        move the camera. F, which looks at what is under the mouse, is a script of the page.
        """
        files = self._files
        ui.command("Save", files.save, "S", "cmd/ctrl", icon="device-floppy")
        ui.command("Save as", files.save_as, "S", "cmd/ctrl+shift")
        ui.command("Open", files.open, "O", "cmd/ctrl", icon="folder-open")
        ui.command("Save image", files.save_image, icon="camera")
        ui.command("Reset", self._reset, "R", icon="refresh")
        ui.command("Add displays by topic", self.add_by_topic, "insert", icon="plus")
        ui.command("Focus on display", self.focus, icon="focus-2")
        ui.command("Duplicate display", self.duplicate, icon="copy")
        ui.command("Remove display", self.remove, "delete", icon="trash")

    def _add(self, browser: int | None) -> None:
        self.selection.expect_new()
        self._send(AddDisplay(self._type.value), browser)

    def _reset(self, browser: int | None) -> None:
        self._send(Reset(), browser)

    def _choose(self, id: str) -> None:
        self.selection.choose(id)
        self._send(Refresh())

    def _edit(self, state: State) -> None:
        row = self.selection.row
        if self._editor is not None and row is not None and self._editor.fits(row):
            self._editor.update(row, state)
        elif self._editor is not None or row is not None:
            with self._server.atomic(), self._box:
                self._replace_editor(state)

    def _replace_editor(self, state: State) -> None:
        if self._editor is not None:
            self._editor.remove()
            self._editor = None
        if (row := self.selection.row) is not None:
            self._editor = Editor(self._gui, row, self._send, self)
            self._editor.update(row, state)
