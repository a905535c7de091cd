"""Entries of lists that a config repeats for each of its robots."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import msgspec

PLACE = "{robot}"
"""Stands for the namespace of a robot in names and topics."""

Repetition = tuple[int, Any, str]
"""An entry: its place in the file, the entry itself, and the robot that it is for, or ""."""


class Template(msgspec.Struct, frozen=True):
    """An entry that was repeated.

    Args:
        entry: as in the file.
        written: what saving makes of each of its repetitions, in their order.
    """

    entry: Any
    written: Sequence[Any]


def folded(entries: Sequence[Any], templates: Sequence[Template]) -> list[Any]:
    """Return a list to save, in which unchanged repetitions of an entry are that entry again."""
    result: list[Any] = []
    place = 0
    while place < len(entries):
        for template in templates:
            count = len(template.written)
            if entries[place : place + count] == template.written:
                result.append(template.entry)
                break
        else:
            result.append(entries[place])
            count = 1
        place += count
    return result


def repeated(entries: Iterable[Any], robots: Sequence[str]) -> list[Repetition]:
    """Each entry with its place in the file and a robot; those with `PLACE` once for each robot.

    Args:
        entries: of a list in a file.
        robots: their names.
    """
    result: list[Repetition] = []
    for place, entry in enumerate(entries):
        names = robots if robots and _mentions(entry) else [""]
        result += [(place, entry, name) for name in names]
    return result


def filled(entry: Any, robot: str) -> Any:
    """Return an entry with a robot in the place of `PLACE`; as it is without one."""
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
