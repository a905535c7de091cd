"""What is shown and where it is saved: the settings and displays of a viewer, and their file."""

from __future__ import annotations

import contextlib
import functools
import logging
import time
from collections.abc import Callable
from concurrent.futures import Future, wait
from pathlib import Path
from typing import Any

import msgspec

from webviz.api.declared import make
from webviz.api.display import Display
from webviz.api.registry import display_types
from webviz.engine.commands import (
    AddDisplay,
    Command,
    DuplicateDisplay,
    Export,
    Load,
    MoveDisplay,
    Open,
    RemoveDisplay,
    Save,
    SetBackground,
    SetFixedFrame,
    SetFrameRate,
    SetProperty,
)
from webviz.engine.display_list import DisplayList
from webviz.engine.requests import Job
from webviz.engine.state import File
from webviz.files import config as config_file
from webviz.files import opening
from webviz.files.config import Config, ConfigError, Settings
from webviz.files.config.disk import in_thread
from webviz.files.config.files import SUFFIXES

log = logging.getLogger("webviz")

MAX_OTHERS = 200
ENDING_S = 0.5
"""How long the end waits until the last state is kept, at most twice."""
NOT_KEPT = "The session is not kept: %s"


class Session:
    """A config at work.

    Args:
        displays: to fill; empty.
        config: what to begin with.
        path: the file it came from, None for none.
        autosave: a file that follows every change, None for none.
        opened: called by the frame loop when another config is shown.
    """

    def __init__(
        self,
        displays: DisplayList,
        config: Config,
        path: Path | None = None,
        autosave: Path | None = None,
        opened: Callable[[], None] = lambda: None,
    ) -> None:
        self.settings = Settings()
        self.displays = displays
        self.report: list[str] = []
        """Sentences on what has no counterpart here, of the .rviz file that is open."""
        self._path = path
        self._folder = path.absolute().parent if path else Path.cwd()
        self._autosave = autosave
        self._opened = opened
        self._others: tuple[str, ...] = ()
        self._listing: Future[tuple[str, ...]] | None = None
        self._keeping: Future[None] | None = None
        self._saved: dict[str, Any] = {}
        self._kept: dict[str, Any] = {}
        self._is_changed = False
        self._show(config)

    def config(self) -> Config:
        """What to save to come back to this: a snapshot, for any thread."""
        return Config(self.settings, self.displays.items())

    def do(self, command: Command) -> str | Job[Any]:
        """Change what is shown, or save it.

        Returns:
            What there is to tell of it, "" for what can be seen; of files, the slow part.

        Raises:
            ConfigError: it cannot be done, or a value does not fit; nothing was changed.
            AttributeError: there is no such property.
        """
        match command:
            case SetProperty(id, path, value):
                self.displays.set(id, path, value)
            case AddDisplay(type, values, group, made):
                made(self.displays.add(_new(type, values), self.displays.group(group)).id)
            case RemoveDisplay(id):
                self.displays.remove(id)
            case DuplicateDisplay(id, made):
                if twin := self.displays.duplicate(id):
                    made(twin.id)
            case MoveDisplay(id, group, before):
                self.displays.move(id, group, before)
            case SetFixedFrame(frame):
                if not (name := frame.removeprefix("/")):
                    raise ConfigError("The fixed frame needs a name.")
                self.set("fixed_frame", name)
            case SetBackground(color):
                self.set("background", color)
            case SetFrameRate(hz):
                self.set("frame_rate", hz)
            case Open(path):
                return self._open(path)
            case Load(text, name):
                return self._load(text, name)
            case Save(path):
                return self._save(path)
            case Export(deliver, name):
                return self._export(deliver, name)
        return ""

    def look(self) -> None:
        """Find out whether something was changed since it was saved, after commands."""
        self._is_changed = config_file.document(self.config()) != self._saved

    def keep(self) -> None:
        """Begin to keep the last state, if that is wanted and anything is new.

        The file is one of its own, so a config that somebody saved is never touched.
        """
        config = self.config()
        values = config_file.document(config)
        is_busy = self._keeping is not None and not self._keeping.done()
        if self._autosave is None or is_busy or values == self._kept:
            return
        self._kept = values
        try:
            self._keeping = in_thread(functools.partial(_keep, config, self._autosave))
        except OSError as error:
            log.warning(NOT_KEPT, error.strerror)

    def close(self) -> None:
        """Keep the last state, if the disk responds soon."""
        deadline = time.monotonic() + ENDING_S
        for _ in range(2):  # what is under way may be older
            if self._keeping is not None:
                wait([self._keeping], max(deadline - time.monotonic(), 0.0))
            self.keep()
        if self._keeping is not None and wait([self._keeping], ENDING_S).not_done:
            log.warning(NOT_KEPT, "the disk does not respond")

    def file(self) -> File:
        """Where this is saved, as a panel shows it."""
        if self._listing is not None and self._listing.done():
            self._others, self._listing = self._listing.result(), None
        path = str(self._path) if self._path else ""
        return File(path, self._is_changed, str(self._folder), self._others)

    def look_around(self) -> None:
        """Begin to look for the config files of the folder; `file` has them a moment later."""
        if self._listing is None:
            with contextlib.suppress(OSError):
                self._listing = in_thread(functools.partial(_config_files, self._folder))

    def set(self, key: str, value: Any) -> None:
        """Change a setting.

        Raises:
            ConfigError: the value does not fit; nothing was changed.
        """
        values = msgspec.to_builtins(self.settings) | {key: value}
        try:
            self.settings = msgspec.convert(values, Settings)
        except msgspec.ValidationError as error:
            found = config_file.explain(error, Settings, values)
            raise ConfigError(f"Not changed: {config_file.sentences([found])}") from error

    def _open(self, path: str) -> Job[Config]:
        wanted = self._folder / path

        def then(config: Config) -> str:
            self._show(config)
            self._path = wanted
            self._opened()
            return f"Opened {wanted.name}."

        return Job(lambda: opening.load(wanted), then)

    def _load(self, text: str, name: str) -> Job[Config]:
        def then(config: Config) -> str:
            self._show(config)
            self._path = None
            self._is_changed = True
            self._saved = {}
            self._opened()
            return f"Opened {name}, which is not saved here yet."

        return Job(lambda: opening.parse(text, name), then)

    def _save(self, path: str) -> Job[None]:
        target = self._folder / path if path else self._path
        if target is None:
            raise ConfigError("This config has no file yet: give it a name.")
        config = self.config()

        def then(_: None) -> str:
            self._path = target
            self._saved = config_file.document(config)
            return f"Saved {target.name}."

        return Job(lambda: opening.save(config, target), then)

    def _export(self, deliver: Callable[[str], None], name: str) -> Job[str]:
        config = self.config()

        def then(text: str) -> str:
            deliver(text)
            return ""

        return Job(lambda: opening.text_of(config, name), then)

    def _show(self, config: Config) -> None:
        self.displays.clear()
        for item in config.displays:
            self.displays.add(item)
        self.settings = config.settings
        self.report = config.report
        self._saved = config_file.document(self.config())
        self._is_changed = False


def _keep(config: Config, path: Path) -> None:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        config_file.write_text(config_file.dump(config), path)
    except (ConfigError, OSError) as error:
        log.warning(NOT_KEPT, error)


def _config_files(folder: Path) -> tuple[str, ...]:
    """The names of the config files in a folder, sorted, not more than can be offered."""
    try:
        names = [path.name for path in folder.iterdir() if path.suffix.lower() in SUFFIXES]
    except OSError:
        names = []
    return tuple(sorted(names)[:MAX_OTHERS])


def _new(type_name: str, values: dict[str, Any]) -> Display:
    types = display_types()
    if type_name not in types:
        hint = config_file.nearest(type_name, types)
        raise ConfigError(f"There is no display type `{type_name}`: {hint}")
    cls = types[type_name]
    try:
        return make(cls, values)
    except msgspec.ValidationError as error:
        found = config_file.mistakes(cls, values, error)
        raise ConfigError(f"Not added: {config_file.sentences(found)}") from error
