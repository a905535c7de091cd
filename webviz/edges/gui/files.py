"""The file of the viewer: where it is saved, and what opens instead."""

from __future__ import annotations

from webviz.api.panel import Send
from webviz.edges.gui.dialogs import Dialogs
from webviz.edges.gui.file_dialogs import Discard, OpenFile, SaveAs
from webviz.engine.commands import Load, Open, Save, SaveImage
from webviz.engine.state import File, State


class Files:
    """What can be done with the file.

    Args:
        dialogs: opens dialogs.
        send: takes commands, from any thread.
    """

    def __init__(self, dialogs: Dialogs, send: Send) -> None:
        self._dialogs = dialogs
        self._send = send
        self._file = File()

    def update(self, state: State) -> None:
        """Know where the viewer saves."""
        self._file = state.file

    def save(self, browser: int | None) -> None:
        """Save, and ask for a name if there is none."""
        if self._file.path:
            self._send(Save(), browser)
        else:
            self.save_as(browser)

    def save_as(self, browser: int | None) -> None:
        """Ask for a name, and save."""
        self._dialogs.open(browser, lambda client: SaveAs(client, self._send, self._file))

    def open(self, browser: int | None) -> None:
        """Ask for a file, and open it; ask again if unsaved changes would be lost."""

        def replace(command: Open | Load) -> None:
            if self._file.is_changed:
                self._dialogs.open(browser, lambda client: Discard(client, self._send, command))
            else:
                self._send(command, browser)

        self._dialogs.open(browser, lambda client: OpenFile(client, replace, self._file))

    def save_image(self, browser: int | None) -> None:
        """Let a browser download what it shows."""
        if browser is not None:
            self._send(SaveImage(), browser)
