"""Other values for every property of a display, derived from their declarations."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any, Literal, get_args, get_origin, get_type_hints

import msgspec

from webviz.api.declared import Topic
from webviz.api.display import Display

NEVER_DRAWN = ("name", "selectable")
"""Properties that show in a browser only: its list, and what the tool Select picks."""


@dataclass(frozen=True)
class Change:
    """A property that is to change what a display draws or reports.

    Args:
        path: of the property; dotted for nested ones.
        hint: its type.
        value: its value before.
        needs: other properties by path, without which it has no effect.
    """

    path: str
    hint: Any
    value: Any
    needs: dict[str, Any]

    def others(self) -> list[Any]:
        """Other values; some may be out of bounds. Names are "robot"."""
        hint, value = self.hint, self.value
        if get_origin(hint) is Literal:
            return [choice for choice in get_args(hint) if choice != value]
        if isinstance(value, bool):
            return [not value]
        if isinstance(value, int):
            found: list[Any] = [value * 3 + 1, value // 2]
        elif isinstance(value, float):
            found = [value * 3 + 50.0, value / 2]
        elif isinstance(value, Topic):
            found = [Topic("/somewhere_else")]
        elif isinstance(value, tuple):
            is_color = isinstance(value[0], int)
            found = [tuple(255 - each for each in value)] if is_color else [(1.0, 2.0, 3.0)]
        elif hint == dict[str, bool]:
            found = [{"robot": False}]
        else:
            assert isinstance(value, str), f"Name other values of {self.path} in `values`."
            found = ["robot"]
        return [each for each in found if each != value]


def changes(cls: type[Display]) -> Iterator[Change]:
    """Each property of a display that may show, those of nested structs included."""
    for change in _leaves(cls, cls(), "", {}):
        if change.path not in NEVER_DRAWN:
            yield change


def _leaves(struct: Any, value: Any, prefix: str, needs: dict[str, Any]) -> Iterator[Change]:
    hints = get_type_hints(struct, include_extras=True)
    for name in value.__struct_fields__:
        hint, current = hints[name], getattr(value, name)
        more = dict(needs)
        _add_condition(name, hints, prefix, more)
        if isinstance(current, msgspec.Struct) and not isinstance(current, Topic):
            yield from _leaves(type(current), current, f"{prefix}{name}.", more)
        else:
            yield Change(f"{prefix}{name}", _plain(hint), current, more)


def _add_condition(name: str, hints: dict[str, Any], prefix: str, needs: dict[str, Any]) -> None:
    """Add what a property declares as `when`."""
    for item in getattr(hints[name], "__metadata__", ()):
        if isinstance(item, msgspec.Meta) and (when := (item.extra or {}).get("when")):
            other, wanted = when
            wanted = wanted[0] if isinstance(wanted, tuple) else wanted
            _add_condition(other, hints, prefix, needs)
            plain = _plain(hints[other])
            is_group = isinstance(plain, type) and issubclass(plain, msgspec.Struct)
            inner = isinstance(wanted, bool) and not prefix and is_group
            needs[f"{prefix}{other}{'.value' if inner else ''}"] = wanted


def _plain(hint: Any) -> Any:
    return get_args(hint)[0] if get_origin(hint) is Annotated else hint
