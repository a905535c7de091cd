"""The menus of interactive markers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from webviz.api.handles import MenuEntry
from webviz.data.words import shortened

FEEDBACK = 0
MAX_ENTRIES = 1000
MAX_DEPTH = 8
MAX_TITLE = 200
"""Characters shown of an entry."""
SHELL = "It would run a shell command on the machine of the viewer, which webviz never does."


def menu_of(entries: Sequence[Any]) -> tuple[tuple[MenuEntry, ...], list[str]]:
    """Return the menu of visualization_msgs/MenuEntry, and what is wrong with it, in sentences.

    An entry belongs into the submenu of its parent, which precedes it in the list.
    """
    problems: list[str] = []
    if len(entries) > MAX_ENTRIES:
        problems.append(f"The menu shows {MAX_ENTRIES} of its {len(entries)} entries.")
    below: dict[int, list[Any]] = {0: []}
    depths = {0: 0}
    for entry in entries[:MAX_ENTRIES]:
        id, parent = int(entry.id), int(entry.parent_id)
        if id == 0 or id in below:
            problems.append(f"The menu has an invalid or repeated id, {id}. Correct the server.")
        elif parent not in below:
            problems.append(f"Menu entry {id} precedes its parent {parent}. Correct the server.")
        elif depths[parent] == MAX_DEPTH:
            problems.append(f"Menu entry {id} is nested more than {MAX_DEPTH} levels deep.")
        else:
            below[id], depths[id] = [], depths[parent] + 1
            below[parent].append(entry)
    return _level(0, below), problems


def can_choose(menu: Sequence[MenuEntry], id: int) -> bool:
    """Return whether a menu has an entry that can be chosen."""
    return any(
        can_choose(entry.entries, id) if entry.entries else entry.id == id and not entry.refusal
        for entry in menu
    )


def _level(id: int, below: dict[int, list[Any]]) -> tuple[MenuEntry, ...]:
    return tuple(_entry(entry, below) for entry in below[id])


def _entry(entry: Any, below: dict[int, list[Any]]) -> MenuEntry:
    title, is_checked = str(entry.title), None
    for mark, checked in (("[x]", True), ("[ ]", False)):
        if title.startswith(mark):
            title, is_checked = title.removeprefix(mark).strip(), checked
    refusal = "" if entry.command_type == FEEDBACK else SHELL
    entries = _level(int(entry.id), below)
    title = shortened(title, MAX_TITLE)
    return MenuEntry(int(entry.id), title, is_checked, "" if entries else refusal, entries)
