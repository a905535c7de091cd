"""The file of the viewer: where it is saved, and what opens instead."""

from __future__ import annotations

from collections.abc import Callable

from webviz.edges.gui.dialogs import Dialogs
from webviz.edges.gui.file_dialogs import Discard, OpenFile, SaveAs
from webviz.engine.commands import Command, Load, Open, Save, SaveImage
from webviz.engine.state import File, State


class Files:
    """What can be done with the file.

    Args:
        dialogs: opens dialogs.
        enqueue: takes commands, from any thread.
    """

    def __init__(self, dialogs: Dialogs, enqueue: Callable[[Command], None]) -> None:
        self._dialogs = dialogs
        self._enqueue = enqueue
        self._file = File()

    def update(self, state: State) -> None:
        """Know where the viewer saves."""
        self._file = state.file

    def save(self, browser: int | None) -> None:
        """Save, and ask for a name if there is none."""
        if self._file.path:
            self._enqueue(Save())
        else:
            self.save_as(browser)

    def save_as(self, browser: int | None) -> None:
        """Ask for a name, and save."""
        self._dialogs.open(browser, lambda client: SaveAs(client, self._enqueue, self._file))

    def open(self, browser: int | None) -> None:
        """Ask for a file, and open it; ask again if unsaved changes would be lost."""

        def replace(command: Open | Load) -> None:
            if self._file.is_changed:
                self._dialogs.open(browser, lambda client: Discard(client, self._enqueue, command))
            else:
                self._enqueue(command)

        self._dialogs.open(browser, lambda client: OpenFile(client, replace, self._file))

    def save_image(self, browser: int | None) -> None:
        """Let a browser download what it shows."""
        if browser is not None:
            self._enqueue(SaveImage(browser))
