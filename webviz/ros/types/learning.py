"""Definitions of installed types, from their classes."""

from __future__ import annotations

import importlib
import re
from typing import Any

from webviz.data.messages import interfaces, register, type_exists
from webviz.data.messages.typestore import PLACEHOLDER

_SEPARATOR = "=" * 80
_PRIMITIVES = {"boolean": "bool", "octet": "byte", "float": "float32", "double": "float64"}
_PARTS = {"srv": ("_Request", "_Response"), "action": ("_Goal", "_Result", "_Feedback")}
_REPEATED = re.compile(
    r"sequence<(?P<inner>[^,]+)(?:, (?P<bound>\d+))?>|(?P<item>.+)\[(?P<size>\d+)\]"
)


def learn(type_name: str) -> None:
    """Register an installed message, service or action type with decoder and encoder.

    Args:
        type_name: such as "my_msgs/msg/Wheel" or "my_msgs/action/Dock", which stands for its parts,
            as each of them does for the whole. Types that are known already or not installed are
            ignored.

    Raises:
        DefinitionError: the type contains what webviz cannot decode, such as a long double.
    """
    package, kind, name = type_name.split("/")
    for part in _PARTS.get(kind, ()):
        name = name.removesuffix(part)
    type_name = f"{package}/{kind}/{name}"
    try:
        cls = getattr(importlib.import_module(f"{package}.{kind}"), name, None)
    except ModuleNotFoundError:
        return
    if cls is None:
        return
    if kind == "msg" and not type_exists(type_name):
        register(type_name, _with_nested(cls))
    elif kind == "srv" and not type_exists(f"{type_name}_Request"):
        interfaces.service(type_name, _joined(cls.Request, cls.Response))
    elif kind == "action" and not type_exists(f"{type_name}_Goal"):
        interfaces.action(type_name, _joined(cls.Goal, cls.Result, cls.Feedback))


def _joined(*parts: Any) -> str:
    """Return the definition of a service or an action; its nested messages are registered."""
    for part in parts:
        for nested in _nested(part):
            learn(nested)
    return "---\n".join(map(_text, parts))


def _with_nested(cls: Any) -> str:
    """Return the definitions of a message and its nested messages, in the format of bags."""
    texts = {"": _text(cls)}
    waiting = _nested(cls)
    while waiting:
        name = waiting.pop()
        if name not in texts:
            package, _, short = name.split("/")
            inner = getattr(importlib.import_module(f"{package}.msg"), short)
            texts[name] = f"{_SEPARATOR}\nMSG: {package}/{short}\n{_text(inner)}"
            waiting += _nested(inner)
    return "".join(texts.values())


def _text(cls: Any) -> str:
    return "".join(f"{_type(kind)} {name}\n" for name, kind in _members(cls))


def _members(cls: Any) -> list[tuple[str, str]]:
    return [
        (name, kind)
        for name, kind in cls.get_fields_and_field_types().items()
        if name != PLACEHOLDER[0]
    ]


def _nested(cls: Any) -> list[str]:
    """Full names of the message types of the members."""
    kinds = [_item(kind) for _, kind in _members(cls)]
    return [kind.replace("/", "/msg/") for kind in kinds if "/" in kind]


def _item(kind: str) -> str:
    match = _REPEATED.fullmatch(kind)
    return (match["inner"] or match["item"]) if match else kind


def _type(kind: str) -> str:
    """Return a type name of rosidl's Python classes in the syntax of .msg files."""
    if match := _REPEATED.fullmatch(kind):
        if match["item"]:
            return f"{_type(match['item'])}[{match['size']}]"
        bound = f"<={match['bound']}" if match["bound"] else ""
        return f"{_type(match['inner'])}[{bound}]"
    if bounded := re.fullmatch(r"(w?string)<(\d+)>", kind):
        return f"{bounded[1]}<={bounded[2]}"
    return _PRIMITIVES.get(kind, kind)
