"""Config files of the viewer's folder: opening, saving, downloading."""

from __future__ import annotations

import contextlib
import functools
import os
import time
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from pathlib import Path, PurePath
from typing import Any

from webviz.api.roles import Role
from webviz.data.disk import in_thread
from webviz.data.names import MAX_FILE_BYTES, MAX_NAME, file_problem_of, readable
from webviz.data.words import joined
from webviz.engine.commands import FileCommand, Sender
from webviz.engine.feature import Feature, command, store
from webviz.engine.parts.config import ConfigPart
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.parts.part import PartContext
from webviz.engine.requests import Job
from webviz.engine.state import ConfigFile
from webviz.files import config as config_file
from webviz.files import opening
from webviz.files.config import Config, ConfigError
from webviz.files.config.files import SUFFIXES, refuse_too_large

MAX_OTHERS = 200
FOLDER_S = 2.0
"""Interval between listings of the config files of the folder."""


class FilesFeature(Feature):
    """Opens and saves config files."""

    name = "Files"
    module = "files.js"

    def __init__(self, context: PartContext) -> None:
        super().__init__(context)
        self._config = context.get(ConfigPart)
        path = self._config.path
        self._folder = path.absolute().parent if path else Path.cwd()
        self._others: tuple[str, ...] = ()
        self._listing: Future[tuple[str, ...]] | None = None
        self._next_listing = 0.0

    def keep_up(self, commanded: bool) -> None:
        """Update the files of the folder."""
        now = time.monotonic()
        if commanded or now >= self._next_listing:
            self._next_listing = now + FOLDER_S
            self._list_folder()

    @store()
    def file(self, argument: str = "") -> ConfigFile:
        """Return the file, and the others of its folder."""
        if self._listing is not None and self._listing.done():
            self._others, self._listing = self._listing.result(), None
        path = str(self._config.path or "")
        return ConfigFile(path, self._config.is_changed, str(self._folder), self._others)

    def state(self) -> Mapping[str, Any]:
        """Return the file."""
        return {"file": self.file()}

    def _list_folder(self) -> None:
        """Begin to list the config files of the folder; `file` takes the result."""
        if self._listing is None:
            with contextlib.suppress(OSError):
                self._listing = in_thread(functools.partial(_config_files, self._folder))

    def _in_folder(self, path: str, sender: Sender) -> Path:
        """Return a file that was named, relative to the folder; for pages one within it."""
        if "\0" in path:
            raise ConfigError("A file name cannot contain a null character. Choose another name.")
        is_config = path == Path(path).name and Path(path).suffix.lower() in SUFFIXES
        if sender.browser is not None and not is_config:
            raise ConfigError(
                f"Pages open and save config files in {self._folder} only. Give a name without "
                "folders that ends with .yaml or .rviz."
            )
        if len(path.encode(errors="replace")) > MAX_FILE_BYTES and is_config:
            raise ConfigError(f"{readable(path)[:40]}… is not a file name: it is too long.")
        return self._folder / path

    def _check(self, file: Path, sender: Sender) -> Callable[[], None]:
        """Refuse files for pages that are not files of the folder; reads the disk."""
        is_free = sender.browser is None or file == self._config.path
        return (lambda: None) if is_free else functools.partial(_refuse_elsewhere, file)

    @command(
        Role.OWNER,
        FileCommand,
        label=lambda each: f"Open {PurePath(each.path).name}",
        is_noted=True,
    )
    def open(self, sender: Sender, path: str) -> Job[Config]:
        """Replace the current config by that of a file."""
        file = self._in_folder(path, sender)
        check = self._check(file, sender)

        def work() -> Config:
            check()
            return opening.load(file)

        def then(config: Config) -> str:
            self._config.open(config, file)
            return f"Opened {file.name}."

        return Job(work, then)

    @command(Role.OWNER, FileCommand, label=lambda each: f"Open {each.name}", is_noted=True)
    def load(self, text: str, name: str) -> Job[Config]:
        """Replace the current config by that of a text.

        Args:
            text: YAML, or RViz's format if the name ends with .rviz.
            name: of the file it came from, which is not accessed.
        """
        name = readable(name[-MAX_NAME:])  # with its ending
        refuse_too_large(len(text), name)

        def then(config: Config) -> str:
            self._config.open(config, None)
            return f"Opened {name} (not yet saved on this machine)."

        return Job(lambda: opening.parse(text, name), then)

    @command(
        Role.OWNER,
        FileCommand,
        label=lambda each: f"Save as {PurePath(each.path).name}",
        is_noted=True,
    )
    def save(self, sender: Sender, path: str = "", replace: bool = True) -> Job[list[str]]:
        """Save the current config to a file.

        Args:
            path: "" is the file that the config came from.
            replace: whether to replace another file of that name.
        """
        target = self._in_folder(path, sender) if path else self._config.path
        is_named = bool(path) and sender.browser is not None
        if is_named and (problem := file_problem_of(path)):
            raise ConfigError(problem)
        if target is None:
            raise ConfigError("This config has no file yet. Choose a name.")
        config = self._config.config()
        check = self._check(target, sender)

        def work() -> list[str]:
            check()
            if not replace and target != self._config.path and target.exists():
                raise ConfigError(f"{target.name} exists already. Choose another name.")
            return opening.save(config, target)

        def then(left_out: list[str]) -> str:
            self._config.note_saved(config, target)
            return joined(f"Saved {target.name}.", *left_out)

        return Job(work, then)

    @command(Role.WATCHER, FileCommand)
    def export(self, deliver: Callable[[str], None], name: str = "") -> Job[tuple[str, list[str]]]:
        """Pass on the current config as text, such as for a download.

        Args:
            deliver: called by the frame loop with the text; must not block.
            name: of the file it is for; RViz's format if it ends with .rviz, else YAML.
        """
        config = self._config.config()

        def then(written: tuple[str, list[str]]) -> str:
            text, left_out = written
            deliver(text)
            return joined(*left_out)

        return Job(lambda: opening.text_of(config, name), then)

    @command(Role.WATCHER, FileCommand)
    def write_displays(self, displays: tuple[str, ...]) -> Job[str]:
        """Answer with the text that a config file has of displays, and of all that is in groups."""
        items = self.context.get(DisplaysPart).list.written(displays)
        return Job(lambda: config_file.dump_displays(items), lambda text: text)


def _refuse_elsewhere(file: Path) -> None:
    """Refuse a link to another folder, and what is no regular file, such as a device.

    Raises:
        ConfigError: it is one of these.
    """
    if os.path.dirname(os.path.realpath(file)) != os.path.realpath(file.parent):
        raise ConfigError(
            f"{file.name} is a link to another folder. Start webviz with this file, or copy it."
        )
    if file.exists() and not file.is_file():
        raise ConfigError(f"{file.name} is not a regular file. Choose another name.")


def _config_files(folder: Path) -> tuple[str, ...]:
    """Return the names of the config files in a folder, sorted, at most `MAX_OTHERS`."""
    try:
        names = [path.name for path in folder.iterdir() if path.suffix.lower() in SUFFIXES]
    except OSError:
        names = []
    return tuple(sorted(names)[:MAX_OTHERS])
