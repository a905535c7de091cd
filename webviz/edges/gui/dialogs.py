"""Dialogs: questions over the page of one browser."""

from __future__ import annotations

import queue
from collections.abc import Callable

import viser

from webviz.api.panel import Send
from webviz.engine.commands import Refresh
from webviz.engine.state import State


class Dialog:
    """One question, in the browser that asked for it.

    It is made and updated by the frame loop; what people do in it comes in viser's threads, which
    only enqueue commands and set `is_done`.

    Args:
        gui: of that browser.
        title: what it is about.
    """

    def __init__(self, gui: viser.GuiApi, title: str) -> None:
        self.gui = gui
        self.modal = gui.add_modal(title)
        self.is_done = False

    def update(self, state: State) -> None:
        """Show the viewer as it is."""

    def finish(self) -> None:
        """Have it closed."""
        self.is_done = True


MakeDialog = Callable[[viser.ClientHandle], Dialog]


class Dialogs:
    """The open dialogs, at most one in each browser.

    Args:
        server: where the browsers are.
        send: takes commands, from any thread.
    """

    def __init__(self, server: viser.ViserServer, send: Send) -> None:
        self._server = server
        self._send = send
        self._asked: queue.SimpleQueue[tuple[int, MakeDialog]] = queue.SimpleQueue()
        self._open: dict[int, Dialog] = {}

    def open(self, browser: int | None, make: MakeDialog) -> None:
        """Open a dialog in a browser instead of the one it has open, from any thread."""
        if browser is not None:
            self._asked.put((browser, make))
            self._send(Refresh(), browser)

    def update(self, state: State) -> None:
        """Open, update and close dialogs; to be called by the frame loop."""
        if not self._open and self._asked.empty():
            return
        connected = self._server.get_clients()
        for id, dialog in list(self._open.items()):
            if id not in connected:
                del self._open[id]  # viser clears what a browser had
            elif dialog.is_done:
                self._close(id)
        while not self._asked.empty():
            browser, make = self._asked.get()
            if browser in connected:
                self._close(browser)
                # In one piece: the page gives the focus to the first control when it opens the
                # dialog, to none if the controls come later.
                with connected[browser].atomic():
                    self._open[browser] = make(connected[browser])
        for dialog in self._open.values():
            dialog.update(state)

    def _close(self, id: int) -> None:
        if dialog := self._open.pop(id, None):
            dialog.modal.close()
