"""Errors for invalid values, in the words of configs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import msgspec

from webviz.api.declared import Declared, make
from webviz.data.words import joined
from webviz.files.config.errors import unknown_key
from webviz.files.config.faults import Fault, first_fault
from webviz.files.config.source import Location, Path

MAX_MISTAKES = 10


def explain(error: msgspec.ValidationError, hint: Any, values: Any) -> Fault:
    """Return the place of an invalid value, and what was expected.

    Args:
        error: of converting `values` to `hint`.
        hint: a type, such as a display's class.
        values: plain values, as in a config file.
    """
    return first_fault(hint, values) or Fault((), str(error))


def mistakes(
    cls: type[Declared],
    values: Mapping[str, Any],
    error: msgspec.ValidationError,
    others: Iterable[str] = (),
) -> list[Fault]:
    """All errors in the properties of a display or tool.

    Args:
        cls: of the display or tool.
        values: plain values, as in a config file.
        error: of making it; it names only the first mistake.
        others: keys that are valid without being properties.
    """
    fields = [*cls.__struct_fields__, *others]
    found: list[Fault] = []
    for key, value in values.items():
        if key not in fields:
            found.append(Fault((key,), unknown_key(key, fields)))
        elif key not in others:
            try:
                make(cls, {key: value})
            except msgspec.ValidationError as single:
                found.append(explain(single, cls, {key: value}))
    return found or [explain(error, cls, values)]  # the values may contradict each other


def sentences(found: Sequence[tuple[Path, str]], place: Location = Location()) -> str:  # noqa: B008
    """Errors with their places, up to a limit."""
    told = [place.at(*path).says(clause) for path, clause in found[:MAX_MISTAKES]]
    if len(found) > MAX_MISTAKES:
        told.append(f"{len(found) - MAX_MISTAKES} more errors.")
    return joined(*told)
