"""What can be done with the selected display as a whole."""

from __future__ import annotations

from typing import Any, Protocol

import viser

from webviz.api.panel import Send
from webviz.edges.gui.moves import Moves
from webviz.edges.gui.selection import Selection
from webviz.edges.gui.style import row_style
from webviz.edges.gui.ui import browser_of
from webviz.engine.commands import MoveDisplay


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
        send: takes commands, from any thread.
        actions: of the tab.
    """

    def __init__(self, gui: viser.GuiApi, send: Send, actions: Actions) -> None:
        self._actions = actions
        self._send = send
        gui.add_html(row_style("toolbar", (8, 8, 8, 6, 6, 6, 6)))
        focus = gui.add_button("Focus", color="gray", hint="Bring this display into view.")
        duplicate = gui.add_button("Duplicate", color="gray", hint="Duplicate below.")
        remove = gui.add_button("Remove", color="gray", hint="Remove this display (Delete)")
        self._up = gui.add_button("Up", color="gray", hint="Move up in the list.")
        self._down = gui.add_button("Down", color="gray", hint="Move down in the list.")
        self._into = gui.add_button("In", color="gray", hint="Move into the nearest group.")
        self._out = gui.add_button("Out", color="gray", hint="Move out of its group.")
        focus.on_click(lambda event: actions.focus(browser_of(event)))
        duplicate.on_click(lambda event: actions.duplicate(browser_of(event)))
        remove.on_click(lambda event: actions.remove(browser_of(event)))
        self._up.on_click(lambda event: self._move(actions.selection.moves.up, event))
        self._down.on_click(lambda event: self._move(actions.selection.moves.down, event))
        self._into.on_click(lambda event: self._move(actions.selection.moves.into, event))
        self._out.on_click(lambda event: self._move(actions.selection.moves.out, event))
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

    def _move(self, command: MoveDisplay | None, event: viser.GuiEvent[Any]) -> None:
        if command is not None:
            self._send(command, browser_of(event))
