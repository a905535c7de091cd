"""The parts of a viewer that are opened before its server, and the end of all of them."""

from __future__ import annotations

import contextlib
import logging
import math
import os
import ssl
import threading
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from webviz.api.errors import Error
from webviz.engine.pipeline import plugins
from webviz.server.access.journal_file import JournalFile
from webviz.server.access.tls import doubts, server_context
from webviz.shell.bag_player import bag_player

if TYPE_CHECKING:
    from webviz.sources import Source


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


log = logging.getLogger("webviz")

BagPaths = str | os.PathLike[str] | Sequence[str | os.PathLike[str]]
"""A bag, or several to merge by time."""


def journal(
    path: str | os.PathLike[str] | None, closing: Closing
) -> Callable[[str], object] | None:
    """Open the file of the journal; returns its writer of lines, None without a file."""
    if path is None:
        return None
    file = JournalFile(Path(path))
    closing.add("The journal", file.close)
    return file.write


def given_source(
    bag: BagPaths | None, source: Source | None, ros_args: Sequence[str], closing: Closing
) -> Source | None:
    """Return the bag or other source that was asked for, None for the ROS graph."""
    if bag is not None:
        if source is not None:
            raise Error("Give either `bag` or `source`.")
        source = bag_player(_paths(bag), ros_args=ros_args)
    if source is not None:
        closing.add("The source of messages", source.close)
    return source


def loaded_plugins(files: Sequence[str | os.PathLike[str]]) -> plugins.Watcher:
    """Load files with plug-ins; returns what watches them for changes."""
    paths = [Path(file) for file in files]
    watcher = plugins.Watcher(paths)
    for path in paths:
        plugins.load(path)
    return watcher


def _paths(bag: BagPaths) -> list[Path]:
    """Return the files and folders of a bag, or of several."""
    several = [bag] if isinstance(bag, str | os.PathLike) else bag
    if not several:
        raise Error("`bag` is empty. Give a file or folder, or None for the ROS graph.")
    return [Path(path) for path in several]


def tls_context(
    certfile: str | os.PathLike[str] | None, keyfile: str | os.PathLike[str] | None
) -> ssl.SSLContext | None:
    """Return the context of a server with TLS, if there is a certificate.

    Doubts about it are logged.
    """
    if certfile is None:
        if keyfile is not None:
            raise Error("`keyfile` needs `certfile`.")
        return None
    context = server_context(Path(certfile), None if keyfile is None else Path(keyfile))
    for doubt in doubts(context, Path(certfile)):
        log.warning("%s", doubt)
    return context
