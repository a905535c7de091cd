"""The base class of features: what a viewer can do, each complete in one folder.

    class WhatIf(Feature):
        module = "what_if.js"

        @command(Role.OPERATOR)
        def try_frame(self, frame: str, sender: Sender) -> None:
            \"\"\"Take hold of a static frame.\"\"\"

        @store()
        def what_if(self, argument: str) -> WhatIfStore | None:
            \"\"\"Return the frame that is tried, None without one.\"\"\"

A command is a method. The class of `webviz.commands`, its fields, what a page may send, its role
and the types of the page follow from its signature: this one is `TryFrame(frame)`. Packages, webviz
among them, declare features as entry points of the group `webviz.features`.
"""

from __future__ import annotations

import functools
import inspect
import sys
from collections.abc import Callable, Mapping, Set
from pathlib import Path
from typing import Any, ClassVar, TypeVar, get_type_hints

import msgspec

from webviz.api.entry_points import installed
from webviz.api.roles import Role
from webviz.engine import commands as engine_commands
from webviz.engine.commands import Command, Sender
from webviz.engine.parts.part import Handler, Part
from webviz.engine.store import PageStore

GROUP = "webviz.features"
SENDER = "sender"
"""The parameter of a command that receives its sender; it is not a field."""

F = TypeVar("F", bound=Callable[..., Any])


class DeclaredCommand(msgspec.Struct, frozen=True):
    """A method that is a command.

    Args:
        type: its class, whose instances are sent.
        role: of pages that may send it; None if none may.
        method: its name.
        has_sender: whether it gets its sender.
    """

    type: type[Command]
    role: Role | None
    method: str
    has_sender: bool


class DeclaredStore(msgspec.Struct, frozen=True):
    """A method that makes a store for pages.

    Args:
        role: of pages that may watch it.
        is_private: whether a page may watch only the one with its id behind the colon.
        make: the function, from a feature and what stands behind the colon.
    """

    role: Role
    is_private: bool
    make: Callable[[Any, str], PageStore | None]


def command(role: Role | None, base: type[Command] = Command) -> Callable[[F], F]:
    """Make a method a command.

    Args:
        role: of pages that may send it; None if only programs may.
        base: `FileCommand` if it may answer with a slow part.
    """

    def declare(method: F) -> F:
        vars(method)["command"] = role, base
        return method

    return declare


def store(role: Role = Role.WATCHER, *, is_private: bool = False) -> Callable[[F], F]:
    """Make a method a store of its name; see `DeclaredStore`."""

    def declare(method: F) -> F:
        vars(method)["store"] = DeclaredStore(role, is_private, method)
        return method

    return declare


class Feature(Part):
    """One capability of a viewer: its commands, its stores, and its module of the page.

    The frame loop calls all methods; see `Part`. Stores are made only while a page watches them.
    """

    module: ClassVar[str] = ""
    """A JavaScript file beside the class, whose function `install` adds it to the page."""

    @property
    def handles(self) -> Mapping[type[Command], Handler]:
        """The handler of each command."""
        return {each.type: self._handler(each) for each in commands_of(type(self)).values()}

    def _handler(self, declared: DeclaredCommand) -> Handler:
        method = getattr(self, declared.method)

        def obey(command: Command, sender: Sender) -> Any:
            fields = {name: getattr(command, name) for name in command.__struct_fields__}
            return method(**fields, sender=sender) if declared.has_sender else method(**fields)

        return obey

    def watched(self, stores: Set[str]) -> None:
        """Note that pages have begun or ceased to watch some of its stores.

        Args:
            stores: the names of those that are watched, with what stands behind the colon.
        """


@functools.cache
def commands_of(feature: type[Feature]) -> Mapping[str, DeclaredCommand]:
    """Return the commands of a feature by name."""
    found = {}
    for name, (role, base) in _marked(feature, "command").items():
        declared = _declared(feature, name, role, base)
        found[declared.type.__name__] = declared
    return found


@functools.cache
def stores_of(feature: type[Feature]) -> Mapping[str, DeclaredStore]:
    """Return the stores of a feature by name."""
    return _marked(feature, "store")


def features() -> Mapping[str, type[Feature]]:
    """Return all features by name."""
    return _loaded()[0]


def broken_features() -> Mapping[str, str]:
    """Return those that cannot be loaded by name, each with the reason."""
    return _loaded()[1]


@functools.cache
def commands() -> Mapping[str, DeclaredCommand]:
    """Return the commands of all features by name."""
    return _united(commands_of)


@functools.cache
def stores() -> Mapping[str, DeclaredStore]:
    """Return the stores of all features by name."""
    return _united(stores_of)


@functools.cache
def texts_of(feature: type[Feature]) -> Mapping[str, str]:
    """Return the modules and style sheets of a feature for the page, by file name.

    Raises:
        OSError, UnicodeDecodeError: one cannot be read.
    """
    if not feature.module:
        return {}
    folder = Path(str(sys.modules[feature.__module__].__file__)).parent
    files = [file for suffix in (".js", ".css") for file in sorted(folder.glob(f"*{suffix}"))]
    return {file.name: file.read_text("utf-8") for file in files}


@functools.cache
def _loaded() -> tuple[dict[str, type[Feature]], dict[str, str]]:
    found: dict[str, type[Feature]] = {}
    broken: dict[str, str] = {}
    taken = {*engine_commands.__all__}
    for point in sorted(installed(GROUP), key=lambda point: point.name):
        try:
            feature = point.load()
            names = {*commands_of(feature), *stores_of(feature)}
            if both := taken & names:
                raise ValueError(f"{', '.join(sorted(both))} exists already")
            texts_of(feature)
            taken |= names
            found[point.name] = feature
        except Exception as error:  # those of other packages may raise anything
            broken[point.name] = f"{point.value} does not load: {type(error).__name__}: {error}"
    return found, broken


def _united(of: Callable[[type[Feature]], Mapping[str, Any]]) -> dict[str, Any]:
    return {name: each for feature in features().values() for name, each in of(feature).items()}


def _marked(feature: type[Feature], mark: str) -> dict[str, Any]:
    """Return what the methods with a mark of `command` or `store` have there, by their names."""
    methods = {name: getattr(feature, name) for name in dir(feature)}
    return {n: vars(m)[mark] for n, m in methods.items() if mark in getattr(m, "__dict__", {})}


def _declared(
    feature: type[Feature], name: str, role: Role | None, base: type[Command]
) -> DeclaredCommand:
    method = getattr(feature, name)
    types = get_type_hints(method, include_extras=True)
    parameters = list(inspect.signature(method).parameters.values())[1:]
    fields: list[Any] = []
    for each in parameters:
        default = () if each.default is each.empty else (each.default,)
        if each.name != SENDER:
            fields.append((each.name, types[each.name], *default))
    made: Any = msgspec.defstruct(
        "".join(word.capitalize() for word in name.split("_")),
        fields,
        bases=(base,),
        module="webviz.commands",
        namespace={"__doc__": method.__doc__},
        frozen=True,
    )
    return DeclaredCommand(made, role, name, any(each.name == SENDER for each in parameters))
