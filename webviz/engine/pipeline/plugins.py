"""Plug-ins from a file, `--plugin FILE.py`, reloaded whenever the file is saved.

A version that does not load only changes a status. After one that does, every display of the file
becomes an instance of its new class with the same values.
"""

from __future__ import annotations

import logging
import sys
import threading
import traceback
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from types import ModuleType, TracebackType
from typing import TYPE_CHECKING, Any

import msgspec

from webviz.api import registry
from webviz.api.check import Check
from webviz.api.check_registry import checks_of, register_checks, registered_checks
from webviz.api.declared import Declared, P, make, set_property, to_values
from webviz.api.display import Display, inputs_of
from webviz.api.errors import Error
from webviz.api.modules import module_texts
from webviz.api.properties import value_at
from webviz.api.status import Level, Status
from webviz.data.words import plain

if TYPE_CHECKING:
    from webviz.engine.pipeline import Runner

log = logging.getLogger("webviz")

MAX_REASON = 300
"""Characters that are quoted of an error."""
POLL_S = 1.0
"""Interval between checks of files for changes."""
STATUS = "Plugin"
"""Key of the status of a reload."""


class PluginError(Error):
    """A file cannot be used as a plug-in; one sentence with the file and line."""


def load(path: Path) -> dict[str, type[Declared]]:
    """Run a Python file and register the plug-ins it defines, replacing its previous ones.

    Plug-ins are the subclasses of `Display`, `Tool`, `Panel` or `Check` defined in the file whose
    names do not start with an underscore.

    Returns:
        The displays, tools and panels by name.

    Raises:
        PluginError: the file is missing, not valid Python, raises, has no plug-in, or has one with
            invalid defaults or a name that is taken. Its previous plug-ins stay registered.
    """
    name = _module_name(path)
    before = sys.modules.get(name)
    module = ModuleType(name)
    module.__file__ = str(path)
    code = _compiled(path)
    sys.modules[name] = module  # annotations given as text are resolved there
    try:
        types = _run(path, code, module)
    except PluginError:
        del sys.modules[name]
        if before is not None:
            sys.modules[name] = before
        raise
    return types


def reload(path: Path, runners: Iterable[Runner]) -> None:
    """Reload a file after it was saved, and make its displays instances of the new classes.

    Args:
        path: as given to `load`.
        runners: of all displays.
    """
    name = _module_name(path)
    own = [runner for runner in runners if type(runner.display).__module__ == name]
    try:
        types = load(path)
    except PluginError as error:
        log.warning("%s Keeping the previous version.", error)
        for runner in own:
            runner.external_statuses[STATUS] = Status(Level.ERROR, str(error))
        return
    log.info("Reloaded %s.", path)
    displays = {name: cls for name, cls in types.items() if issubclass(cls, Display)}
    for runner in own:
        _renew(runner, displays, path)


class Watcher:
    """Requests a reload of each file that was saved.

    Args:
        paths: of the files, as they are loaded now.
    """

    def __init__(self, paths: Iterable[Path]) -> None:
        self._stamps = {path: _stamp(path) for path in paths}
        self._ended = threading.Event()
        self._thread: threading.Thread | None = None

    def start(self, reload: Callable[[Path], object]) -> None:
        """Check the files every `POLL_S`, in a thread, until `stop`."""
        if self._stamps:
            self._thread = threading.Thread(target=self._watch, args=[reload], daemon=True)
            self._thread.start()

    def stop(self) -> None:
        """End the thread."""
        self._ended.set()
        if self._thread is not None:
            self._thread.join()

    def changed(self) -> list[Path]:
        """Return the files that changed since the last call."""
        now = {path: _stamp(path) for path in self._stamps}
        changed = [path for path, stamp in now.items() if stamp != self._stamps[path]]
        self._stamps = now
        return changed

    def _watch(self, reload: Callable[[Path], object]) -> None:
        while not self._ended.wait(POLL_S):
            for path in self.changed():
                reload(path)


def _stamp(path: Path) -> tuple[int, ...] | None:
    """Differs after a save, in place or by replacing the file."""
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_mtime_ns, status.st_size, status.st_ino


def _module_name(path: Path) -> str:
    return f"webviz plugin {path.absolute()}"


def _compiled(path: Path) -> Any:
    """Return the code of a file from its text: byte-code caches miss saves within a second."""
    try:
        return compile(path.read_bytes(), str(path), "exec", dont_inherit=True)
    except OSError as error:
        raise PluginError(f"Cannot read {path}: {error.strerror or error}.") from error
    except SyntaxError as error:
        place = f"{path}:{error.lineno}" if error.lineno else str(path)
        raise PluginError(f"{place} is not valid Python: {error.msg}.") from error
    except ValueError as error:  # such as null bytes
        raise PluginError(f"{path} is not valid Python: {error}.") from error
    except (RecursionError, MemoryError) as error:
        raise PluginError(f"{path} is not valid Python: it is nested too deeply.") from error


def _run(path: Path, code: Any, module: ModuleType) -> dict[str, type[Declared]]:
    try:
        exec(code, vars(module))
        types, checks = _classes_of(module), list(checks_of(module))
        for cls in types.values():
            if issubclass(cls, Display):
                inputs_of(cls)
            module_texts(cls)
            make(cls, msgspec.to_builtins(cls()))  # defaults fit their own types and bounds
    except BaseException as error:  # plug-ins may raise anything
        place = f"{path}:{line}" if (line := _line(path, error.__traceback__)) else str(path)
        text = f"{type(error).__name__}: {_message(error)}".rstrip(": ").rstrip(".")
        raise PluginError(f"{place} does not load: {text}.") from error
    if not types and not checks:
        bases = "Display, Tool, Panel or Check"
        raise PluginError(f"{path} has no plug-in. Define a subclass of {bases} in it.")
    _register(path, types, checks)
    return types


def _message(error: BaseException) -> str:
    try:
        return plain(str(error), MAX_REASON)
    except Exception:  # of the plug-in's own class
        return ""


def _register(
    path: Path, types: Mapping[str, type[Declared]], checks: Sequence[type[Check]]
) -> None:
    owner, before = str(path), registered_checks(str(path))
    try:
        register_checks(owner, checks)
    except ValueError as error:
        raise PluginError(f"{path} cannot be used: {error}. Give it another id.") from error
    try:
        registry.register(owner, types)
    except ValueError as error:
        register_checks(owner, before)
        raise PluginError(f"{path} cannot be used: {error}. Rename the class.") from error


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
    """Return the innermost line of the file in a traceback."""
    lines = [each.lineno for each in traceback.extract_tb(trace) if each.filename == str(path)]
    return lines[-1] if lines else None


def _renew(runner: Runner, types: Mapping[str, type[Display]], path: Path) -> None:
    old = runner.display
    name = type(old).__name__
    runner.external_statuses.pop(STATUS, None)
    if name not in types:
        text = f"{path} no longer has a display {name}. Keeping the previous version."
        runner.external_statuses[STATUS] = Status(Level.ERROR, text)
        log.warning("%s (%s)", text, old.name)
        return
    display, losses = made_new(old, types[name])
    runner.replace(display)
    if losses:
        text = f"{path} has changed, values were dropped: {'; '.join(losses)}."
        runner.external_statuses[STATUS] = Status(Level.WARN, text)
        log.warning("%s (%s)", text, old.name)


def made_new(old: Declared, cls: type[P]) -> tuple[P, list[str]]:
    """Return an instance of a class with an older one's values, and those that do not fit."""
    successor = make(cls, {})
    losses = [
        problem
        for key, value in to_values(old).items()
        for problem in _carry_over(successor, key, value)
    ]
    return successor, losses


def _carry_over(content: Declared, path: str, value: Any) -> list[str]:
    """Set a property if it still exists and the value fits; else the reason, per property."""
    try:
        if isinstance(value, dict) and isinstance(value_at(content, path), msgspec.Struct):
            return [
                problem
                for key, item in value.items()
                for problem in _carry_over(content, f"{path}.{key}", item)
            ]
        set_property(content, path, value)
    except AttributeError:
        return [f"{path} = {value!r} (no such property)"]
    except Exception as error:  # of validation, or of the class itself
        return [f"{path} = {value!r} ({error})"]
    return []
