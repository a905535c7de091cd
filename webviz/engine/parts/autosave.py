"""A file that follows every change."""

from __future__ import annotations

import functools
import logging
import time
from concurrent.futures import Future, wait
from pathlib import Path
from typing import Any

from webviz.engine.parts.files import FilesPart
from webviz.engine.parts.part import Core, Part
from webviz.files import config as config_file
from webviz.files.config import Config, ConfigError
from webviz.files.config.disk import in_thread

log = logging.getLogger("webviz")

AUTOSAVE_S = 2.0
ENDING_S = 0.5
"""How long the end waits until the last state is kept, at most twice."""
NOT_KEPT = "The session is not kept: %s"


class AutosavePart(Part):
    """Keeps the last state.

    The file is one of its own, so a config that somebody saved is never touched.

    Args:
        core: what all parts share.
        files: what to keep.
        path: of the file.
    """

    name = "Autosave"

    def __init__(self, core: Core, files: FilesPart, path: Path) -> None:
        super().__init__(core)
        self._files = files
        self._path = path
        self._keeping: Future[None] | None = None
        self._kept: dict[str, Any] = {}
        self._next = 0.0

    def keep_up(self, commanded: bool) -> None:
        """Keep the last state now and then."""
        if (now := time.monotonic()) >= self._next:
            self._next = now + AUTOSAVE_S
            self._keep()

    def close(self) -> None:
        """Keep the last state, if the disk responds soon."""
        deadline = time.monotonic() + ENDING_S
        for _ in range(2):  # what is under way may be older
            if self._keeping is not None:
                wait([self._keeping], max(deadline - time.monotonic(), 0.0))
            self._keep()
        if self._keeping is not None and wait([self._keeping], ENDING_S).not_done:
            log.warning(NOT_KEPT, "the disk does not respond")

    def _keep(self) -> None:
        """Begin to keep the state, if anything of it is new."""
        config = self._files.config()
        values = config_file.document(config)
        is_busy = self._keeping is not None and not self._keeping.done()
        if is_busy or values == self._kept:
            return
        self._kept = values
        try:
            self._keeping = in_thread(functools.partial(_write, config, self._path))
        except OSError as error:
            log.warning(NOT_KEPT, error.strerror)


def _write(config: Config, path: Path) -> None:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        config_file.write_text(config_file.dump(config), path)
    except (ConfigError, OSError) as error:
        log.warning(NOT_KEPT, error)
