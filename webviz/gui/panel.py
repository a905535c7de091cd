"""The panel "Displays" of every browser."""

from __future__ import annotations

from collections.abc import Callable

import viser

from webviz.commands import AddDisplay, Command, Reset, SetFixedFrame
from webviz.gui.control import Choice
from webviz.gui.display_list import DisplayList
from webviz.gui.editor import Editor
from webviz.gui.style import row_style
from webviz.gui.text import StatusLines
from webviz.registry import display_types
from webviz.state import Row, State

WIDTH_PX = 340


class Panel:
    """RViz's panel "Displays": global options, the list, and the properties of one display.

    All browsers share it. What people do becomes commands; what they see comes from `update`.

    Args:
        server: where the panel appears.
        enqueue: takes commands; called from viser's threads, must not block.
    """

    def __init__(self, server: viser.ViserServer, enqueue: Callable[[Command], None]) -> None:
        self._server = server
        self._gui = server.gui
        self._enqueue = enqueue
        self._selected: str | None = None
        self._ids: tuple[str, ...] = ()
        self._select_new = False
        self._editor: Editor | None = None
        self._gui.set_panel_label("Displays")
        self._gui.main_panel.dock_left()
        self._gui.main_panel.set_width(WIDTH_PX)
        with self._gui.add_folder("Global", order=0):
            self._fixed_frame = Choice(
                self._gui,
                "Fixed Frame",
                "",
                lambda frame: enqueue(SetFixedFrame(frame)),
                "The frame that everything is drawn in.",
            )
            self._statuses = StatusLines(self._gui)
            reset = self._gui.add_button("Reset", icon=viser.Icon.REFRESH, color="gray")
            reset.on_click(lambda _: enqueue(Reset()))
        self._list = DisplayList(self._gui, enqueue, self._select, order=1)
        types = tuple(display_types())
        with self._gui.add_folder("Add", order=2, visible=bool(types)):
            self._gui.add_html(row_style())
            self._type = self._gui.add_dropdown("", types or ("",))
            add = self._gui.add_button("Add", color="gray")
            add.on_click(lambda _: self._add())

    def update(self, state: State) -> None:
        """Show the viewer as it is; sends only what differs from what is shown.

        To be called by the frame loop some times a second, and after commands: edits settle with
        time.
        """
        self._fixed_frame.offer(state.frames, state.fixed_frame)
        self._fixed_frame.show(state.fixed_frame)
        if (types := tuple(display_types())) != self._type.options and types:
            self._type.options = types  # a plug-in brought some
        self._statuses.show(state.statuses)
        self._follow_rows(state)
        self._list.update(state.rows, self._selected)
        self._edit(state)

    def _select(self, id_: str) -> None:
        self._selected = id_

    def _add(self) -> None:
        self._select_new = True
        self._enqueue(AddDisplay(self._type.value))

    def _follow_rows(self, state: State) -> None:
        """Keep a display selected: a new one somebody added, or the successor of a removed one."""
        ids = tuple(row.id for row in state.rows)
        if ids == self._ids:
            return
        new = [id_ for id_ in ids if id_ not in self._ids]
        if self._select_new and new:
            self._selected, self._select_new = new[-1], False
        elif self._selected not in ids:
            index = self._ids.index(self._selected) if self._selected in self._ids else 0
            self._selected = ids[min(index, len(ids) - 1)] if ids else None
        self._ids = ids

    def _edit(self, state: State) -> None:
        row = next((row for row in state.rows if row.id == self._selected), None)
        if self._editor is not None and row is not None and self._editor.fits(row):
            self._editor.update(row, state)
        elif self._editor is not None or row is not None:
            with self._server.atomic():
                self._replace_editor(row, state)

    def _replace_editor(self, row: Row | None, state: State) -> None:
        if self._editor is not None:
            self._editor.remove()
            self._editor = None
        if row is not None:
            self._editor = Editor(self._gui, row, self._enqueue, order=3)
            self._editor.update(row, state)
