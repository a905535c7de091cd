"""Commands and stores that are methods of parts.

The class of `webviz.commands`, its fields, what a page may send, its role and the types of the page
follow from the signature of a method: `try_frame(self, frame: str, sender: Sender)` is
`TryFrame(frame)`.
"""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Mapping
from typing import Any, TypeVar, get_type_hints

import msgspec

from webviz.api.roles import Role
from webviz.engine.commands import Command, PageCommand
from webviz.engine.store import PageStore

SENDER = "sender"
"""The parameter of a command that receives its sender; it is not a field."""
PAGE_REQUEST = "page_request"
"""The parameter of a `PageCommand` that receives what a page asks for; it is not a field."""

F = TypeVar("F", bound=Callable[..., Any])


class DeclaredCommand(msgspec.Struct, frozen=True):
    """A method that is a command.

    Args:
        type: its class, a `Command` or `PageCommand`, whose instances are sent.
        role: of pages that may send it; None if none may.
        method: its name.
        has_sender: whether it gets its sender.
        is_noted: whether owners read in the journal who did it.
    """

    type: type[Any]
    role: Role | None
    method: str
    has_sender: bool
    is_noted: bool


class DeclaredStore(msgspec.Struct, frozen=True):
    """A method that makes a store for pages.

    Args:
        name: of the store.
        role: of pages that may watch it.
        is_private: whether a page may watch only the one with its id behind the colon.
        of: returns what it is made of; it is made anew when that is something else. None for what
            is quick to make: equal values are not sent again.
        make: the function, from a part and what stands behind the colon.
    """

    name: str
    role: Role
    is_private: bool
    of: Callable[[Any], object] | None
    make: Callable[[Any, str], PageStore | None]


class _Mark(msgspec.Struct, frozen=True):
    """Notes of `command` about a method."""

    role: Role | None
    base: type[Command | PageCommand]
    label: Callable[[Any], str] | None
    name: str
    is_noted: bool


def command(
    role: Role | None,
    base: type[Command | PageCommand] = Command,
    label: Callable[[Any], str] | None = None,
    name: str = "",
    *,
    is_noted: bool = False,
) -> Callable[[F], F]:
    """Make a method a command.

    Args:
        role: of pages that may send it; None if only programs may.
        base: `FileCommand` if it may answer with a slow part; `PageCommand` if it is called on the
            event loop, and answers the page through its parameter `page_request`.
        label: of the step that undoes it, from the command; None derives it from what has changed.
        name: of its class; "" is that of the method.
        is_noted: whether owners read in the journal who did it.
    """

    def declare(method: F) -> F:
        vars(method)["command"] = _Mark(role, base, label, name, is_noted)
        return method

    return declare


def store(
    role: Role = Role.WATCHER,
    *,
    is_private: bool = False,
    name: str = "",
    of: Callable[[Any], object] | None = None,
) -> Callable[[F], F]:
    """Make a method a store of this name, or of its own; see `DeclaredStore`."""

    def declare(method: F) -> F:
        vars(method)["store"] = DeclaredStore(name or method.__name__, role, is_private, of, method)
        return method

    return declare


@functools.cache
def commands_of(part: type[object]) -> Mapping[str, DeclaredCommand]:
    """Return the commands of a part by name."""
    commands = {}
    for name, mark in _marked(part, "command").items():
        declared = _declared(part, name, mark)
        commands[declared.type.__name__] = declared
    return commands


@functools.cache
def stores_of(part: type[object]) -> Mapping[str, DeclaredStore]:
    """Return the stores of a part by name."""
    return {each.name: each for each in _marked(part, "store").values()}


def _marked(part: type[object], mark: str) -> dict[str, Any]:
    """Return what the methods with a mark of `command` or `store` have there, by their names."""
    methods = {name: getattr(part, name) for name in dir(part)}
    return {n: vars(m)[mark] for n, m in methods.items() if mark in getattr(m, "__dict__", {})}


def _declared(part: type[object], name: str, mark: _Mark) -> DeclaredCommand:
    method = getattr(part, name)
    types = get_type_hints(method, include_extras=True)
    parameters = list(inspect.signature(method).parameters.values())[1:]
    fields: list[Any] = []
    for each in parameters:
        default = () if each.default is each.empty else (each.default,)
        if each.name not in (SENDER, PAGE_REQUEST):
            fields.append((each.name, types[each.name], *default))
    label = {"label": property(mark.label)} if mark.label else {}
    struct: Any = msgspec.defstruct(
        mark.name or "".join(word.capitalize() for word in name.split("_")),
        fields,
        bases=(mark.base,),
        module="webviz.commands",
        namespace={"__doc__": method.__doc__, **label},
        frozen=True,
    )
    has_sender = any(each.name == SENDER for each in parameters)
    return DeclaredCommand(struct, mark.role, name, has_sender, mark.is_noted)
