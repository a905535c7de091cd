"""The tab "Displays": the file, global options, the list, and the properties of one display."""

from __future__ import annotations

from collections.abc import Callable

import viser

from webviz.api.registry import display_types
from webviz.edges.gui.add_by_topic import AddByTopic
from webviz.edges.gui.dialogs import Dialogs
from webviz.edges.gui.display_list import DisplayList
from webviz.edges.gui.editor import Editor
from webviz.edges.gui.files import Files
from webviz.edges.gui.global_options import GlobalOptions
from webviz.edges.gui.selection import Selection
from webviz.edges.gui.style import WHOLE, row_style
from webviz.engine.commands import (
    AddDisplay,
    Command,
    DuplicateDisplay,
    FocusDisplay,
    Refresh,
    RemoveDisplay,
    Reset,
)
from webviz.engine.state import State


class DisplaysTab:
    """RViz's panel "Displays".

    Args:
        server: where the panel appears; the widgets go into the tab that is open.
        enqueue: takes commands, from any thread.
        dialogs: opens dialogs.
        files: saves and opens.
    """

    def __init__(
        self,
        server: viser.ViserServer,
        enqueue: Callable[[Command], None],
        dialogs: Dialogs,
        files: Files,
    ) -> None:
        self._server = server
        self._gui = gui = server.gui
        self._enqueue = enqueue
        self._dialogs = dialogs
        self.selection = Selection()
        self._editor: Editor | None = None
        self._box = gui.add_folder(None)
        with self._box:
            file_row, others, add_row = (4, 6, 4, 5, 5), (WHOLE, WHOLE), (12, 5, 7)
            gui.add_html(row_style("displays", (*file_row, *others, *add_row)))
            self._add_file_row(files)
            self._options = GlobalOptions(gui, enqueue)
            self._list = DisplayList(gui, enqueue, self._choose)
            self._type = gui.add_dropdown("", tuple(display_types()) or ("",))
            self._add_buttons()

    def update(self, state: State) -> None:
        """Show the viewer as it is."""
        self._options.update(state)
        if (types := tuple(display_types())) != self._type.options and types:
            self._type.options = types  # a plug-in brought some
        self.selection.follow(state.rows)
        self._list.update(state.rows, self.selection.id)
        self._edit(state)

    def add_by_topic(self, client: viser.ClientHandle | None) -> None:
        """Ask which of the live topics to show."""
        self._dialogs.open(
            client, lambda client: AddByTopic(client, self._enqueue, self.selection.expect_new)
        )

    def focus(self, client: viser.ClientHandle | None) -> None:
        """Let a browser look at the selected display."""
        if self.selection.id is not None and client is not None:
            self._enqueue(FocusDisplay(self.selection.id, client.client_id))

    def duplicate(self) -> None:
        """Add a copy of the selected display, and select it."""
        if self.selection.id is not None:
            self.selection.expect_new()
            self._enqueue(DuplicateDisplay(self.selection.id))

    def remove(self) -> None:
        """Remove the selected display."""
        if self.selection.id is not None:
            self._enqueue(RemoveDisplay(self.selection.id))

    def _add_file_row(self, files: Files) -> None:
        gui = self._gui
        save = gui.add_button("Save", color="gray", hint="Ctrl+S")
        save_as = gui.add_button("Save as", color="gray", hint="Or download: Ctrl+Shift+S")
        open_ = gui.add_button("Open", color="gray", hint="Or upload: Ctrl+O")
        image = gui.add_button("Image", color="gray", hint="Download a picture of your view.")
        reset = gui.add_button("Reset", color="gray", hint="Forget transforms and messages: R")
        save.on_click(lambda event: files.save(event.client))
        save_as.on_click(lambda event: files.save_as(event.client))
        open_.on_click(lambda event: files.open(event.client))
        image.on_click(lambda event: files.save_image(event.client))
        reset.on_click(lambda _: self._enqueue(Reset()))

    def _add_buttons(self) -> None:
        gui = self._gui
        add = gui.add_button("Add", color="gray", hint="Add a display of this type.")
        by_topic = gui.add_button("By topic", color="gray", hint="Add displays for live topics.")
        add.on_click(lambda _: self._add())
        by_topic.on_click(lambda event: self.add_by_topic(event.client))

    def _add(self) -> None:
        self.selection.expect_new()
        self._enqueue(AddDisplay(self._type.value))

    def _choose(self, id: str) -> None:
        self.selection.choose(id)
        self._enqueue(Refresh())

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
            self._editor = Editor(self._gui, row, self._enqueue, self)
            self._editor.update(row, state)
