"""The end of a viewer: its parts are closed in the reverse order of their start."""

from __future__ import annotations

import contextlib
import logging
import math
import threading
import time
from collections.abc import Callable

log = logging.getLogger("webviz")

CLOSING_S, ALL_CLOSING_S = 1.5, 2.0
"""Time in seconds for a part to close, and for all: a program that is asked to end has three
seconds."""
LAST_S = 0.1
"""Time in seconds for each part that remains after that."""


class Closing:
    """Closes the parts of a viewer in the reverse order; those that hang are reported and left.

    They share one time limit, so that a program ends in time however many of them are slow.
    """

    def __init__(self, stack: contextlib.ExitStack) -> None:
        self._stack = stack
        self._until = math.inf

    def add(self, what: str, close: Callable[[], object]) -> None:
        """Close a part when the stack is closed."""
        self._stack.callback(self._close, what, close)

    def before(self, call: Callable[[], object]) -> None:
        """Call something, which must not block, before the parts so far are closed."""
        self._stack.callback(call)

    def _close(self, what: str, close: Callable[[], object]) -> None:
        self._until = min(self._until, time.monotonic() + ALL_CLOSING_S)
        thread = threading.Thread(target=close, name="webviz-closing", daemon=True)
        thread.start()
        patience_s = min(CLOSING_S, max(LAST_S, self._until - time.monotonic()))
        thread.join(patience_s)
        if thread.is_alive():
            log.warning("%s did not close within %.1f s.", what, patience_s)
