"""The session: unsaved changes are kept in a file of their own, and restored at the next start."""

from __future__ import annotations

import functools
import logging
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import msgspec

from webviz.api.status import Level, Status
from webviz.data.words import joined
from webviz.engine.commands import Command
from webviz.engine.parts.autosave import AutosavePart
from webviz.engine.parts.config import ConfigPart, Restore
from webviz.engine.parts.part import PartContext
from webviz.files import config as config_file
from webviz.files import sessions
from webviz.files.config import ConfigError
from webviz.files.sessions import Base, Session

log = logging.getLogger("webviz")


class SessionPart(AutosavePart):
    """Keeps what differs from the config that the viewer was started with.

    Args:
        context: shared by all parts.
        files: has the state.
        path: of the session file, which is removed while there is nothing to keep.
    """

    name = "Session"

    def __init__(self, context: PartContext, files: ConfigPart, path: Path) -> None:
        super().__init__(context, files, path)
        self._start = files.path
        self._base = Base.of(files.saved(self._start) or {})
        self._problem = ""

    def restored(self, is_wanted: bool) -> Command | None:
        """Read the session of the last viewer; one that does not fit is set aside.

        Args:
            is_wanted: whether to restore it, else it is set aside.
        """
        try:
            if not self._path.exists():
                return None
            if not is_wanted:
                self._set_aside()
                return None
            session = sessions.read(self._path)
        except (ConfigError, OSError) as error:
            return self._refuse(str(error))
        if session.base.digest != self._base.digest:
            return self._refuse("The config or its options have changed since.")
        settings = session.config.settings
        if session.base.fixed_frame != self._base.fixed_frame:  # another one was given
            frame = self._files.config().settings.fixed_frame
            settings = msgspec.structs.replace(settings, fixed_frame=frame)
        session.config.settings = settings
        path = Path(session.path) if session.path else None
        return Restore(**{"config": session.config, "path": path})

    def statuses(self) -> Mapping[str, Status]:
        """Say why the last session is not shown."""
        return {"Session": Status(Level.WARN, self._problem)} if self._problem else {}

    def _pending(self) -> tuple[Any, Callable[[], None]]:
        files = self._files
        saved = files.saved(self._start)
        if saved is not None:
            self._base = Base.of(saved)
        config = files.config()
        values = config_file.document(config)
        if files.path == self._start and values == saved:
            return None, functools.partial(sessions.remove, self._path)
        session = Session(config, str(files.path or ""), self._base)
        return (values, files.path), functools.partial(sessions.write, session, self._path)

    def _refuse(self, reason: str) -> None:
        self._problem = f"The last session was not restored: {reason}"
        try:
            self._problem = joined(self._problem, f"It is kept in {self._set_aside()}.")
        except OSError as error:
            log.warning("%s It cannot be renamed: %s", self._problem, error.strerror)
        else:
            log.warning("%s", self._problem)

    def _set_aside(self) -> Path:
        return sessions.set_aside(self._path)
