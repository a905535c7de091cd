"""Plug-ins from a file, `--plugin FILE.py`, that follow the file while it is edited.

A save that does not load changes nothing but a status. After a good one every display of the file
goes on as an instance of its new class, with the values it had.
"""

from __future__ import annotations

import logging
import sys
import threading
import traceback
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from types import ModuleType, TracebackType
from typing import TYPE_CHECKING, Any

import msgspec

from webviz.api import registry
from webviz.api.declared import Declared, make, set_property, to_values
from webviz.api.display import Display, inputs_of
from webviz.api.errors import Error
from webviz.api.status import Level, Status
from webviz.engine.commands import Command, ReloadPlugin

if TYPE_CHECKING:
    from webviz.engine.pipeline import Runner

log = logging.getLogger("webviz")

POLL_S = 1.0
"""How often to look whether a file was saved."""
STATUS = "Plugin"
"""Key of the status that tells of a reload."""


class PluginError(Error):
    """A file cannot be used as a plug-in; one sentence that names the file and the place in it."""


def load(path: Path) -> dict[str, type[Declared]]:
    """Run a Python file and register the plug-ins it defines, in place of those it had before.

    Every subclass of `Display`, `Tool` or `Panel` that the file itself defines counts, by the name
    of the class, unless that begins with an underscore.

    Raises:
        PluginError: the file is missing, no Python, raises, has no plug-in, or has one that cannot
            be made or whose name is taken. What was registered before stays.
    """
    name = _module_name(path)
    before = sys.modules.get(name)
    module = ModuleType(name)
    module.__file__ = str(path)
    code = _compiled(path)
    sys.modules[name] = module  # where annotations given as text are looked up
    try:
        types = _run(path, code, module)
    except PluginError:
        del sys.modules[name]
        if before is not None:
            sys.modules[name] = before
        raise
    return types


def reload(path: Path, runners: Iterable[Runner]) -> None:
    """Load a file again after it was saved, and let its displays go on as what it says now.

    Args:
        path: as given to `load`.
        runners: all displays of the viewer.
    """
    name = _module_name(path)
    own = [runner for runner in runners if type(runner.display).__module__ == name]
    try:
        types = load(path)
    except PluginError as error:
        log.warning("%s Keeping the last version that loaded.", error)
        for runner in own:
            runner.remarks[STATUS] = Status(Level.ERROR, str(error))
        return
    log.info("%s was loaded again.", path)
    displays = {name: cls for name, cls in types.items() if issubclass(cls, Display)}
    for runner in own:
        _renew(runner, displays, path)


class Watcher:
    """Asks for a reload of each file that was saved.

    Args:
        paths: files; what they are when this is made counts as known.
    """

    def __init__(self, paths: Iterable[Path]) -> None:
        self._known = {path: _stamp(path) for path in paths}
        self._ended = threading.Event()
        self._thread: threading.Thread | None = None

    def start(self, enqueue: Callable[[Command], object]) -> None:
        """Look every second, in a thread, until `stop`."""
        if self._known:
            self._thread = threading.Thread(target=self._watch, args=[enqueue], daemon=True)
            self._thread.start()

    def stop(self) -> None:
        """End the thread."""
        self._ended.set()
        if self._thread is not None:
            self._thread.join()

    def look(self) -> list[Path]:
        """The files that changed since the last look."""
        now = {path: _stamp(path) for path in self._known}
        changed = [path for path, stamp in now.items() if stamp != self._known[path]]
        self._known = now
        return changed

    def _watch(self, enqueue: Callable[[Command], object]) -> None:
        while not self._ended.wait(POLL_S):
            for path in self.look():
                enqueue(ReloadPlugin(path))


def _stamp(path: Path) -> tuple[int, ...] | None:
    """Differs after a save, in place or by a new file of the same name."""
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino


def _module_name(path: Path) -> str:
    return f"webviz plugin {path.absolute()}"


def _compiled(path: Path) -> Any:
    """The code of a file, always from its text: caches of byte code see no save within a second."""
    try:
        return compile(path.read_bytes(), str(path), "exec", dont_inherit=True)
    except OSError as error:
        raise PluginError(f"Cannot read {path}: {error.strerror or error}.") from error
    except SyntaxError as error:
        place = f"{path}:{error.lineno}" if error.lineno else str(path)
        raise PluginError(f"{place} is not valid Python: {error.msg}.") from error
    except ValueError as error:  # such as null bytes
        raise PluginError(f"{path} is not valid Python: {error}.") from error


def _run(path: Path, code: Any, module: ModuleType) -> dict[str, type[Declared]]:
    try:
        exec(code, vars(module))
        types = _classes_of(module)
        for cls in types.values():
            if issubclass(cls, Display):
                inputs_of(cls)
            make(cls, msgspec.to_builtins(cls()))  # defaults fit their own types and bounds
    except (Exception, SystemExit) as error:  # somebody else's code may raise anything
        place = f"{path}:{line}" if (line := _line(path, error.__traceback__)) else str(path)
        text = f"{type(error).__name__}: {error}".rstrip(": ").rstrip(".")
        raise PluginError(f"{place} does not load: {text}.") from error
    if not types:
        bases = "Display, Tool or Panel"
        raise PluginError(f"{path} has no plug-in: no subclass of {bases} is defined in it.")
    try:
        registry.register(str(path), types)
    except ValueError as error:
        raise PluginError(f"{path} cannot be used: {error}; rename the class.") from error
    return types


def _classes_of(module: ModuleType) -> dict[str, type[Declared]]:
    return {
        value.__name__: value
        for value in vars(module).values()
        if isinstance(value, type)
        and issubclass(value, Declared)
        and value.kind
        and value.__module__ == module.__name__
        and not value.__name__.startswith("_")
    }


def _line(path: Path, trace: TracebackType | None) -> int | None:
    """The innermost line of the file that was at work."""
    lines = [each.lineno for each in traceback.extract_tb(trace) if each.filename == str(path)]
    return lines[-1] if lines else None


def _renew(runner: Runner, types: Mapping[str, type[Display]], path: Path) -> None:
    old = runner.display
    name = type(old).__name__
    runner.remarks.pop(STATUS, None)
    if name not in types:
        text = f"{path} has no display {name} any more. Keeping the previous version."
        runner.remarks[STATUS] = Status(Level.ERROR, text)
        log.warning("%s (%s)", text, old.name)
        return
    display = make(types[name], {})
    lost = [
        problem
        for key, value in to_values(old).items()
        for problem in _carry_over(display, key, value)
    ]
    runner.replace(display)
    if lost:
        text = f"{path} has changed, values were dropped: {'; '.join(lost)}."
        runner.remarks[STATUS] = Status(Level.WARN, text)
        log.warning("%s (%s)", text, old.name)


def _carry_over(display: Display, path: str, value: Any) -> list[str]:
    """Set a property if it still exists and the value fits; else why not, one text per property."""
    if isinstance(value, dict) and isinstance(_value(display, path), msgspec.Struct):
        return [
            problem
            for key, item in value.items()
            for problem in _carry_over(display, f"{path}.{key}", item)
        ]
    try:
        set_property(display, path, value)
    except AttributeError:
        return [f"{path} = {value!r} (no such property)"]
    except Exception as error:  # it does not fit, or a check of the class itself fails
        return [f"{path} = {value!r} ({error})"]
    return []


def _value(display: Display, path: str) -> Any:
    value: Any = display
    for part in path.split("."):
        value = getattr(value, part, None)
    return value
