"""Entries of lists that a config repeats for each of its robots."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

PLACE = "{robot}"
"""Stands for the namespace of a robot in names and topics."""


def repeated(entries: Iterable[Any], robots: Sequence[str]) -> list[tuple[int, Any, str]]:
    """Each entry with its place in the file and a robot; those with `PLACE` once for each robot.

    Args:
        entries: of a list in a file.
        robots: their names.
    """
    result = []
    for place, entry in enumerate(entries):
        names = robots if robots and _mentions(entry) else [""]
        result += [(place, entry, name) for name in names]
    return result


def filled(entry: Any, robot: str) -> Any:
    """An entry with a robot in the place of `PLACE`; as it is without one."""
    if not robot:
        return entry
    if isinstance(entry, str):
        return entry.replace(PLACE, robot)
    if isinstance(entry, Mapping):
        return {key: filled(value, robot) for key, value in entry.items()}
    if isinstance(entry, list):
        return [filled(each, robot) for each in entry]
    return entry


def _mentions(entry: Any) -> bool:
    if isinstance(entry, Mapping):
        return any(map(_mentions, entry.values()))
    return any(map(_mentions, entry)) if isinstance(entry, list) else PLACE in str(entry)
