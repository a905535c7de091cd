"""The list of displays: a check box and a name each, as in RViz."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import viser

from webviz.api.panel import Send
from webviz.api.status import Level
from webviz.edges.gui.control import Control
from webviz.edges.gui.moves import GROUP
from webviz.edges.gui.style import Look, list_style
from webviz.edges.gui.text import MARKS, plain
from webviz.engine.commands import SetProperty
from webviz.engine.state import Row


class DisplayList:
    """Rows of a check box and a button that selects the display.

    A click on a group that is selected already folds it, or unfolds it again.

    Args:
        gui: viser's GUI.
        send: takes commands, from any thread.
        select: called with the id of a display when somebody clicks on its name, in a thread of
            viser's.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        send: Send,
        select: Callable[[str], None],
    ) -> None:
        self._gui = gui
        self._send = send
        self._select = select
        self._rows: dict[str, _Line] = {}
        self._folded: set[str] = set()
        self._selected: str | None = None
        self._ids: tuple[str, ...] = ()
        self._look: list[Look] = []
        self._folder = gui.add_folder("Displays")
        with self._folder:
            self._style = gui.add_html("", order=-1)

    def update(self, rows: Sequence[Row], selected: str | None) -> None:
        """Show these displays."""
        if (ids := tuple(row.id for row in rows)) != self._ids:
            self._ids = ids
            self._arrange(rows)
        self._selected = selected
        look = []
        folded_at: int | None = None  # depth of the folded group that the next rows are in
        for row in rows:
            line = self._rows[row.id]
            is_hidden = folded_at is not None and row.depth > folded_at
            line.show(not is_hidden)
            if is_hidden:
                continue
            is_folded = row.id in self._folded
            folded_at = row.depth if is_folded else None
            level = row.level
            line.update(row, level, is_folded)
            bright = _enabled(row) or row.display is None
            look.append(Look(level, bright, row.id == selected, row.depth))
        if look != self._look:
            self._look = look
            self._style.content = list_style(look)

    def _arrange(self, rows: Sequence[Row]) -> None:
        for gone in self._rows.keys() - set(self._ids):
            self._rows.pop(gone).remove()
            self._folded.discard(gone)
        with self._folder:
            for row in rows:
                if row.id not in self._rows:
                    self._rows[row.id] = _Line(self._gui, row, self._send, self._click)
        for index, id_ in enumerate(self._ids):
            self._rows[id_].place(index)

    def _click(self, row: Row) -> None:
        if row.type == GROUP and row.id == self._selected:
            self._folded ^= {row.id}
        self._select(row.id)


class _Line:
    """Check box and name of one display."""

    def __init__(
        self,
        gui: viser.GuiApi,
        row: Row,
        send: Send,
        click: Callable[[Row], None],
    ) -> None:
        self._box = gui.add_checkbox("", _enabled(row))
        self._control = Control(
            self._box,
            lambda value, browser: send(SetProperty(row.id, "enabled", value), browser),
        )
        self._button = gui.add_button("")
        self._button.on_click(lambda _: click(row))
        self._shown: tuple[str, Level, bool, bool] | None = None
        self._visible = True

    def update(self, row: Row, level: Level, folded: bool) -> None:
        self._control.show(_enabled(row))
        shown = (row.name, level, row.display is None, folded)
        if shown != self._shown:
            self._shown = shown
            fold = ("▸" if folded else "▾") if row.type == GROUP else ""
            self._button.label = f"{fold} {MARKS[level]} {plain(row.name)}".strip()
            self._box.disabled = row.display is None

    def show(self, visible: bool) -> None:
        if visible != self._visible:
            self._visible = visible
            self._box.visible = self._button.visible = visible

    def place(self, index: int) -> None:
        self._box.order = 2.0 * index
        self._button.order = 2.0 * index + 1.0

    def remove(self) -> None:
        self._box.remove()
        self._button.remove()


def _enabled(row: Row) -> bool:
    return row.display is not None and row.display.enabled
