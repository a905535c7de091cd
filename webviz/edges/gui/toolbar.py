"""What can be done with the selected display as a whole."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import viser

from webviz.edges.gui.moves import Moves
from webviz.edges.gui.selection import Selection
from webviz.edges.gui.style import row_style
from webviz.edges.gui.ui import browser_of
from webviz.engine.commands import Command, MoveDisplay


class Actions(Protocol):
    """What the panel "Displays" does with the selected display."""

    selection: Selection

    def focus(self, browser: int | None) -> None:
        """Let a browser look at it."""
        ...

    def duplicate(self, browser: int | None) -> None:
        """Add a copy, and select it."""
        ...

    def remove(self, browser: int | None) -> None:
        """Remove it."""
        ...


class Toolbar:
    """Buttons: look at it, duplicate, remove, and four ways in the list.

    Args:
        gui: viser's GUI; the buttons go into the folder that is open.
        enqueue: takes commands, from any thread.
        actions: of the tab.
    """

    def __init__(
        self, gui: viser.GuiApi, enqueue: Callable[[Command], None], actions: Actions
    ) -> None:
        self._actions = actions
        self._enqueue = enqueue
        gui.add_html(row_style("toolbar", (8, 8, 8, 6, 6, 6, 6)))
        focus = gui.add_button("Focus", color="gray", hint="Bring all of it into your view.")
        duplicate = gui.add_button("Duplicate", color="gray", hint="Add a copy behind it.")
        remove = gui.add_button("Remove", color="gray", hint="Remove it: Delete")
        self._up = gui.add_button("Up", color="gray", hint="Move it up in the list.")
        self._down = gui.add_button("Down", color="gray", hint="Move it down in the list.")
        self._into = gui.add_button("In", color="gray", hint="Move it into the nearest group.")
        self._out = gui.add_button("Out", color="gray", hint="Move it out of its group.")
        focus.on_click(lambda event: actions.focus(browser_of(event)))
        duplicate.on_click(lambda event: actions.duplicate(browser_of(event)))
        remove.on_click(lambda event: actions.remove(browser_of(event)))
        self._up.on_click(lambda _: self._move(actions.selection.moves.up))
        self._down.on_click(lambda _: self._move(actions.selection.moves.down))
        self._into.on_click(lambda _: self._move(actions.selection.moves.into))
        self._out.on_click(lambda _: self._move(actions.selection.moves.out))
        self._moves: Moves | None = None

    def update(self) -> None:
        """Offer the ways there are."""
        moves = self._actions.selection.moves
        if moves is not self._moves:
            self._moves = moves
            self._up.disabled = moves.up is None
            self._down.disabled = moves.down is None
            self._into.disabled = moves.into is None
            self._out.disabled = moves.out is None

    def _move(self, command: MoveDisplay | None) -> None:
        if command is not None:
            self._enqueue(command)
