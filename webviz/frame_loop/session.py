"""What is shown and where it is saved: the settings and displays of a viewer, and their file."""

from __future__ import annotations

import logging
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec

from webviz import config as config_file
from webviz import rviz
from webviz.commands import (
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
from webviz.config import Config, ConfigError, Settings
from webviz.config.files import SUFFIXES
from webviz.display import Display, make
from webviz.frame_loop.display_list import DisplayList
from webviz.registry import display_types
from webviz.state import File

log = logging.getLogger("webviz")

MAX_OTHERS = 200


class Session:
    """A config at work.

    Args:
        displays: to fill; empty.
        config: what to begin with.
        path: the file it came from, None for none.
        folder: where names without a folder are meant.
        autosave: a file that follows every change, None for none.
    """

    def __init__(
        self,
        displays: DisplayList,
        config: Config,
        path: Path | None = None,
        autosave: Path | None = None,
    ) -> None:
        self.settings = Settings()
        self.displays = displays
        self.report: list[str] = []
        """Sentences on what has no counterpart here, of the .rviz file that is open."""
        self._path = path
        self._folder = path.absolute().parent if path else Path.cwd()
        self._autosave = autosave
        self._others: tuple[str, ...] = ()
        self._saved: dict[str, Any] = {}
        self._kept: dict[str, Any] = {}
        self._is_changed = False
        self._show(config)

    def config(self) -> Config:
        """What to save to come back to this."""
        return Config(self.settings, self.displays.items())

    def do(self, command: Command) -> str:
        """Change what is shown, or save it.

        Returns:
            What there is to tell of it, "" for what can be seen.

        Raises:
            ConfigError: a file cannot be read or written; nothing was changed.
            msgspec.ValidationError: a value does not fit; nothing was changed.
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
                self.set("fixed_frame", frame)
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
                deliver(self._text(name))
        return ""

    def look(self) -> None:
        """Find out whether something was changed since it was saved, after commands."""
        self._is_changed = config_file.document(self.config()) != self._saved

    def keep(self) -> Callable[[], None] | None:
        """What to do so that the last state is kept, if that is wanted and anything is new.

        It may run in any thread, and logs what goes wrong. The file is one of its own, so a config
        that somebody saved is never touched.
        """
        values, path = config_file.document(self.config()), self._autosave
        if path is None or values == self._kept:
            return None
        self._kept = values
        text = config_file.dump(self.config())

        def write() -> None:
            try:
                path.parent.mkdir(parents=True, exist_ok=True)
                config_file.write_text(text, path)
            except (ConfigError, OSError) as error:
                log.warning("The session is not kept: %s", error)

        return write

    def file(self) -> File:
        """Where this is saved, as a panel shows it."""
        path = str(self._path) if self._path else ""
        return File(path, self._is_changed, str(self._folder), self._others)

    def look_around(self) -> None:
        """Find the config files of the folder."""
        try:
            names = [p.name for p in self._folder.iterdir() if p.suffix.lower() in SUFFIXES]
        except OSError:
            names = []
        self._others = tuple(sorted(names)[:MAX_OTHERS])

    def set(self, key: str, value: Any) -> None:
        """Change a setting.

        Raises:
            msgspec.ValidationError: the value does not fit; nothing was changed.
        """
        values = msgspec.to_builtins(self.settings) | {key: value}
        self.settings = msgspec.convert(values, Settings)

    def _open(self, path: str) -> str:
        wanted = self._folder / path
        self._show(config_file.load(wanted))
        self._path = wanted
        return f"Opened {wanted.name}."

    def _load(self, text: str, name: str) -> str:
        if config_file.is_rviz(Path(name)):
            config = rviz.read(text, name)[0]
        else:
            config = config_file.parse(text, name)
        self._show(config)
        self._path = None
        self._is_changed = True
        self._saved = {}
        return f"Opened {name}, which is not saved here yet."

    def _save(self, path: str) -> str:
        if not path and self._path is None:
            raise ConfigError("This config has no file yet: give it a name.")
        target = self._path if not path else self._folder / path
        assert target is not None
        config_file.save(self.config(), target)
        self._path = target
        self._saved = config_file.document(self.config())
        self._is_changed = False
        return f"Saved {target.name}."

    def _text(self, name: str) -> str:
        config = self.config()
        return (
            rviz.write(config)[0] if config_file.is_rviz(Path(name)) else config_file.dump(config)
        )

    def _show(self, config: Config) -> None:
        self.displays.clear()
        for item in config.displays:
            self.displays.add(item)
        self.settings = config.settings
        self.report = config.report
        self._saved = config_file.document(self.config())
        self._is_changed = False


def _new(type_name: str, values: dict[str, Any]) -> Display:
    types = display_types()
    if type_name not in types:
        hint = config_file.nearest(type_name, types)
        raise ConfigError(f"There is no display type `{type_name}`: {hint}")
    return make(types[type_name], values)
