"""What came of commands, told to every browser."""

from __future__ import annotations

from typing import Literal

import viser

from webviz.api.status import Level
from webviz.edges.gui.text import plain
from webviz.engine.state import Answer

Color = Literal["green", "orange", "red"]

TITLES = {Level.OK: "Done", Level.WARN: "Warning", Level.ERROR: "Failed"}
COLORS: dict[Level, Color] = {Level.OK: "green", Level.WARN: "orange", Level.ERROR: "red"}
SECONDS = {Level.OK: 4.0, Level.WARN: 10.0, Level.ERROR: 10.0}


class Answers:
    """Shows each new answer for some seconds.

    Args:
        server: where the browsers are.
    """

    def __init__(self, server: viser.ViserServer) -> None:
        self._server = server
        self._number = 0

    def update(self, answer: Answer) -> None:
        """Tell this answer if nobody was told yet."""
        if answer.number == self._number:
            return
        self._number = answer.number
        for client in self._server.get_clients().values():
            tell(client, answer.level, answer.text)


def tell(client: viser.ClientHandle, level: Level, text: str) -> None:
    """Show a browser for some seconds how something went."""
    client.add_notification(
        TITLES[level], plain(text), auto_close_seconds=SECONDS[level], color=COLORS[level]
    )
