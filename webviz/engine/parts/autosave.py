"""Autosave: a session file that follows every change."""

from __future__ import annotations

import functools
import logging
import time
from collections.abc import Callable
from concurrent.futures import Future, wait
from pathlib import Path
from typing import Any

import msgspec

from webviz.data.disk import in_thread
from webviz.engine.parts.config import ConfigPart
from webviz.engine.parts.part import Part, PartContext
from webviz.files import config as config_file
from webviz.files.config import Config, ConfigError

log = logging.getLogger("webviz")

AUTOSAVE_S = 2.0
ENDING_S = 0.5
"""Time `close` waits for the disk, at most twice."""
NOT_SAVED = "The session is not saved: %s"


class AutosavePart(Part):
    """Saves the last state to a file of its own, so the config file is never overwritten.

    Args:
        context: shared by all parts.
        files: has the state.
        path: of the file.
    """

    name = "Autosave"

    def __init__(self, context: PartContext, files: ConfigPart, path: Path) -> None:
        super().__init__(context)
        self._files = files
        self._path = path
        self._saving: Future[None] | None = None
        self._saved: Any = None
        self._is_due = True
        self._warned = ""
        self._next = 0.0

    def keep_up(self, commanded: bool) -> None:
        """Save the state every `AUTOSAVE_S` while commands come."""
        self._is_due |= commanded
        if self._is_due and (now := time.monotonic()) >= self._next:
            self._next = now + AUTOSAVE_S
            self._save()

    def close(self) -> None:
        """Save the last state, if the disk responds in time."""
        deadline = time.monotonic() + ENDING_S
        for _ in range(2):  # the file being written may be older
            if self._saving is not None:
                wait([self._saving], max(deadline - time.monotonic(), 0.0))
            self._save()
        if self._saving is not None and wait([self._saving], ENDING_S).not_done:
            log.warning(NOT_SAVED, "the disk does not respond")

    def _save(self) -> None:
        """Begin to save the state, if it changed."""
        if self._saving is not None and not self._saving.done():
            return
        self._is_due = False
        state, write = self._pending()
        if state == self._saved:
            return
        self._saved = state
        try:
            self._saving = in_thread(functools.partial(self._write, write))
        except OSError as error:
            self._warn(str(error.strerror))

    def _pending(self) -> tuple[Any, Callable[[], None]]:
        """Return the state to save, to compare with what was saved last, and its writer."""
        config = self._files.config()
        if config.settings.publish is None:
            # What pages have changed must not become the list of the next start.
            names = self.context.graph.rights.names
            config.settings = msgspec.structs.replace(config.settings, publish=names)
        return config_file.document(config), functools.partial(_write, config, self._path)

    def _write(self, write: Callable[[], None]) -> None:
        try:
            write()
        except (ConfigError, OSError) as error:
            self._warn(str(error))

    def _warn(self, reason: str) -> None:
        """Log a problem once, however often it comes."""
        if reason != self._warned:
            self._warned = reason
            log.warning(NOT_SAVED, reason)


def _write(config: Config, path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    config_file.write_text(config_file.dump(config), path)
