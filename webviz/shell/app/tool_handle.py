"""Handles of tools for Python programs."""

from __future__ import annotations

import contextlib
from concurrent.futures import Future, InvalidStateError
from typing import TYPE_CHECKING

from webviz import commands
from webviz.api.errors import Error
from webviz.api.status import Level, Status

if TYPE_CHECKING:
    from webviz.shell.app.running import Running

PATIENCE_S = 5.0
"""For a tool to report the result of a gesture."""


class ToolHandle:
    """A tool, by its name in the toolbar."""

    def __init__(self, viewer: Running, name: str) -> None:
        self._viewer = viewer
        self.name = name

    def send(self, x: float, y: float, yaw: float = 0.0, z: float = 0.0) -> str:
        """Use the tool as with a gesture on the page.

        Args:
            x, y, z: position in metres in the fixed frame.
            yaw: heading in radians.

        Returns:
            The result, as a sentence.

        Raises:
            Error: the tool is unknown, or it could not publish.
        """
        first: Future[Status] = Future()

        def report(status: Status) -> None:
            with contextlib.suppress(InvalidStateError):  # a tool may report more than once
                first.set_result(status)

        self._viewer.do(commands.UseTool(self.name, ((x, y, z),), yaw, report=report))
        try:
            status = first.result(PATIENCE_S)
        except TimeoutError:
            raise Error(f"{self.name} reported nothing within {PATIENCE_S:g} s.") from None
        if status.level is Level.ERROR:
            raise Error(status.text)
        return status.text
