"""The config file: opening, saving, and whether it is up to date."""

from __future__ import annotations

import contextlib
import functools
import os
import time
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from pathlib import Path, PurePath
from typing import Any

from webviz.api.panel import Panel
from webviz.api.roles import Role
from webviz.api.status import Level, Status
from webviz.api.tool import Tool
from webviz.data.disk import in_thread
from webviz.data.names import MAX_FILE_BYTES, MAX_NAME, file_problem_of, readable
from webviz.data.words import counted, joined
from webviz.engine.commands import Command, FileCommand, Sender
from webviz.engine.parts.declaring import command, commands_of, store
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.parts.part import Core, Part
from webviz.engine.parts.plugin_list import PluginList
from webviz.engine.parts.settings import SettingsPart
from webviz.engine.parts.snapshots import Origin
from webviz.engine.parts.views import ViewsPart
from webviz.engine.requests import Job
from webviz.engine.state import ConfigFile
from webviz.files import config as config_file
from webviz.files import opening
from webviz.files.config import Config, ConfigError, Template
from webviz.files.config.files import SUFFIXES, refuse_too_large

MAX_OTHERS = 200
RESTORE = "Restore "
"""Before the amount in the label of a step."""
FOLDER_S = 2.0
"""Interval between listings of the config files of the folder."""


class FilesPart(Part):
    """The config that is shown, and its file.

    Args:
        core: shared by all parts.
        displays: empty; filled with those of the config.
        settings: replaced by those of the config.
        views: reset when another config is opened.
        tools, panels: replaced by those of the config.
        config: what to show first.
        path: its file, None if it has none.
    """

    name = "Files"

    def __init__(
        self,
        core: Core,
        displays: DisplaysPart,
        settings: SettingsPart,
        views: ViewsPart,
        tools: PluginList[Tool],
        panels: PluginList[Panel],
        config: Config,
        path: Path | None = None,
    ) -> None:
        super().__init__(core)
        self.displays = displays
        self.settings = settings
        self.views = views
        self.tools = tools
        self.panels = panels
        self._path: Path | None = None
        self._folder = path.absolute().parent if path else Path.cwd()
        self._report: list[str] = []
        self._templates: tuple[Template, ...] = ()
        self._others: tuple[str, ...] = ()
        self._listing: Future[tuple[str, ...]] | None = None
        self._next_listing = 0.0
        self._saved: dict[Path | None, dict[str, Any]] = {}
        """The content of the file, by its path."""
        self._is_changed = False
        self._show(config, path)
        views.start_with(config.settings.view)

    @property
    def path(self) -> Path | None:
        """The config file, None if there is none."""
        return self._path

    def saved(self, path: Path | None) -> Mapping[str, Any] | None:
        """Return the content of a config file as far as it is known; see `config.document`."""
        return self._saved.get(path)

    def config(self) -> Config:
        """Return the current config: a snapshot, for any thread."""
        displays, tools, panels = self.displays.list, self.tools, self.panels
        return Config(
            self.settings.settings,
            displays.items(),
            tools.items(),
            panels.items(),
            templates=self._templates,
        )

    def origin(self) -> Origin:
        """Where the config comes from."""
        return Origin(self._path, self._report, self._templates)

    def set_origin(self, origin: Origin) -> None:
        """Say where the config comes from; of another file than the last it counts as changed."""
        self._path, self._report = origin.path, list(origin.report)
        self._templates = origin.templates

    def keep_up(self, commanded: bool) -> None:
        """Update whether there are unsaved changes, and the files of the folder."""
        if commanded:
            self._is_changed = config_file.document(self.config()) != self._saved.get(self._path)
        now = time.monotonic()
        if commanded or now >= self._next_listing:
            self._next_listing = now + FOLDER_S
            self._list_folder()

    @store()
    def file(self, argument: str = "") -> ConfigFile:
        """Return the file, and the others of its folder."""
        if self._listing is not None and self._listing.done():
            self._others, self._listing = self._listing.result(), None
        path = str(self._path) if self._path else ""
        return ConfigFile(path, self._is_changed, str(self._folder), self._others)

    def state(self) -> Mapping[str, Any]:
        """Return the file."""
        return {"file": self.file()}

    def statuses(self) -> Mapping[str, Status]:
        """Return the unsupported parts of the open .rviz file."""
        if not self._report:
            return {}
        text = joined("Parts of this .rviz file are unsupported.", *self._report)
        return {"Import": Status(Level.WARN, text)}

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
        is_free = sender.browser is None or file == self._path
        return (lambda: None) if is_free else functools.partial(_refuse_elsewhere, file)

    @command(
        Role.OWNER,
        FileCommand,
        label=lambda each: f"Open {PurePath(each.path).name}",
        is_noted=True,
    )
    def open(self, sender: Sender, path: str) -> Job[Config]:
        """Replace the current config by that of a file."""
        wanted = self._in_folder(path, sender)
        check = self._check(wanted, sender)

        def work() -> Config:
            check()
            return opening.load(wanted)

        def then(config: Config) -> str:
            self._show(config, wanted)
            self.views.open(config.settings.view)
            return f"Opened {wanted.name}."

        return Job(work, then)

    @command(None, label=lambda each: f"{RESTORE}{_amount(each.config)}")
    def restore(self, config: Config, path: Path | None) -> str:
        """Show the unsaved changes of the last session; undo brings back the config as it is saved.

        Args:
            config: as it was shown.
            path: of the config file that was open, None for none.
        """
        saved, origin = self._saved, self.origin()
        self._show(config, path)
        if path == origin.path:
            self.set_origin(origin)
        self._saved, self._is_changed = saved, True
        self.views.open(config.settings.view)
        return f"Restored {_amount(config)} of the last session."

    @command(Role.OWNER, FileCommand, label=lambda each: f"Open {each.name}", is_noted=True)
    def load(self, text: str, name: str) -> Job[Config]:
        """Replace the current config by that of a text.

        Args:
            text: YAML, or RViz's format if the name ends with .rviz.
            name: of the file it came from, which is not accessed.
        """
        text, name = text, readable(name[-MAX_NAME:])  # with its ending
        refuse_too_large(len(text), name)

        def then(config: Config) -> str:
            self._show(config, None)
            self._is_changed = True
            self._saved = {}
            self.views.open(config.settings.view)
            return f"Opened {name} (not yet saved on this machine)."

        return Job(lambda: opening.parse(text, name), then)

    @command(
        Role.OWNER,
        FileCommand,
        label=lambda each: f"Save as {PurePath(each.path).name}",
        is_noted=True,
    )
    def save(self, sender: Sender, path: str = "") -> Job[list[str]]:
        """Save the current config to a file; "" is the file it came from."""
        target = self._in_folder(path, sender) if path else self._path
        is_named = bool(path) and sender.browser is not None
        if is_named and (problem := file_problem_of(path)):
            raise ConfigError(problem)
        if target is None:
            raise ConfigError("This config has no file yet. Choose a name.")
        config = self.config()
        check = self._check(target, sender)

        def work() -> list[str]:
            check()
            return opening.save(config, target)

        def then(left_out: list[str]) -> str:
            self._path = target
            self._saved = {target: config_file.document(config)}
            return joined(f"Saved {target.name}.", *left_out)

        return Job(work, then)

    @command(Role.WATCHER, FileCommand)
    def export(self, deliver: Callable[[str], None], name: str = "") -> Job[tuple[str, list[str]]]:
        """Pass on the current config as text, such as for a download.

        Args:
            deliver: called by the frame loop with the text; must not block.
            name: of the file it is for; RViz's format if it ends with .rviz, else YAML.
        """
        config = self.config()

        def then(written: tuple[str, list[str]]) -> str:
            text, left_out = written
            deliver(text)
            return joined(*left_out)

        return Job(lambda: opening.text_of(config, name), then)

    @command(Role.WATCHER, FileCommand)
    def write_displays(self, displays: tuple[str, ...]) -> Job[str]:
        """Answer with the text that a config file has of displays, and of all that is in groups."""
        items = self.displays.list.written(displays)
        return Job(lambda: config_file.dump_displays(items), lambda text: text)

    def _show(self, config: Config, path: Path | None) -> None:
        self.displays.list.clear()
        self.displays.list.add(config.displays)
        self.settings.settings = config.settings
        self.tools.show(config.tools)
        self.panels.show(config.panels)
        self._path = path
        self._report = config.report
        self._templates = config.templates
        self._saved = {path: config_file.document(self.config())}
        self._is_changed = False


Restore: type[Command] = commands_of(FilesPart)["Restore"].type
"""The command that brings back the last session."""


def _amount(config: Config) -> str:
    """Return the number of displays, in words."""
    return counted(len(config.displays), "display")


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
