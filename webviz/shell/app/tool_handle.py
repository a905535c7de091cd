"""A tool of a viewer, for Python programs."""

from __future__ import annotations

import contextlib
from concurrent.futures import Future, InvalidStateError

from webviz.api.errors import Error
from webviz.api.status import Level, Status
from webviz.engine.commands import UseTool
from webviz.shell.app.handles import Owner

PATIENCE_S = 5.0
"""For a tool to report what came of a stroke."""


class ToolHandle:
    """A tool of the toolbar.

    Args:
        viewer: that shows it.
        name: as in the toolbar.
    """

    def __init__(self, viewer: Owner, name: str) -> None:
        self._viewer = viewer
        self.name = name

    def send(self, x: float, y: float, yaw: float = 0.0) -> str:
        """Do what a stroke on the page does.

        Args:
            x, y: where, in metres in the fixed frame.
            yaw: the heading in radians.

        Returns:
            What came of it: a sentence.

        Raises:
            Error: there is no such tool, or nothing was published; a sentence.
        """
        first: Future[Status] = Future()

        def tell(status: Status) -> None:
            with contextlib.suppress(InvalidStateError):  # a tool may report more than once
                first.set_result(status)

        self._viewer.do(UseTool(self.name, ((x, y, 0.0),), yaw, tell=tell))
        try:
            status = first.result(PATIENCE_S)
        except TimeoutError:
            raise Error(f"{self.name} reported nothing within {PATIENCE_S:g} s.") from None
        if status.level is Level.ERROR:
            raise Error(status.text)
        return status.text
