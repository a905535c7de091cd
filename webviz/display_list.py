"""The displays of a viewer in their groups, in the order of the list."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from webviz import config as config_file
from webviz.config import Branch, Item, Unreadable
from webviz.display import set_property
from webviz.group import Group
from webviz.pipeline import Runner, Services
from webviz.registry import type_name
from webviz.state import Row
from webviz.status import Level, Status

log = logging.getLogger("webviz")


@dataclass(eq=False)
class Entry:
    """One line of the list.

    Args:
        id: for commands.
        content: a display at work, a group, or an entry of a config that cannot be shown.
        parent: the group it is in.
    """

    id: str
    content: Runner | Group | Unreadable
    parent: Entry | None = None

    @property
    def depth(self) -> int:
        """In how many groups it is."""
        return 0 if self.parent is None else 1 + self.parent.depth

    @property
    def is_enabled(self) -> bool:
        """Whether nothing switches it off: neither itself nor a group it is in."""
        content = self.content
        own = content.display if isinstance(content, Runner) else content
        enabled = isinstance(own, Unreadable) or own.enabled
        return enabled and (self.parent is None or self.parent.is_enabled)

    def is_within(self, other: Entry) -> bool:
        """Whether it is `other` or in it."""
        return self is other or (self.parent is not None and self.parent.is_within(other))


class DisplayList:
    """All displays, each group before what is in it.

    Args:
        services: of the runners.
    """

    def __init__(self, services: Services) -> None:
        self._services = services
        self._entries: list[Entry] = []
        self._made = 0

    def add(self, item: Item, parent: Entry | None = None) -> None:
        """Add a display, or a group with all that is in it, at the end of a group or the list."""
        self._made += 1
        id = f"display{self._made}"
        if isinstance(item, Branch):
            group = Entry(id, item.group, parent)
            self._insert(group)
            for each in item.displays:
                self.add(each, group)
        elif isinstance(item, Unreadable):
            log.warning("%s", item.reason)
            self._insert(Entry(id, item, parent))
        elif isinstance(item, Group):
            self._insert(Entry(id, item, parent))
        else:
            self._insert(Entry(id, Runner(id, item, self._services), parent))

    def remove(self, id: str) -> None:
        """Remove a display, or a group with all that is in it."""
        if not (gone := self.find(id)):
            return
        for entry in self._entries:
            if entry.is_within(gone) and isinstance(entry.content, Runner):
                entry.content.close()
        self._entries = [entry for entry in self._entries if not entry.is_within(gone)]
        self._number()

    def group(self, id: str) -> Entry | None:
        """The entry of an id, if it is a group; nothing else can hold displays."""
        entry = self.find(id)
        return entry if entry and isinstance(entry.content, Group) else None

    def find(self, id: str) -> Entry | None:
        """The entry of an id."""
        return next((entry for entry in self._entries if entry.id == id), None)

    def set(self, id: str, path: str, value: Any) -> None:
        """Change a property of a display or a group.

        Raises:
            msgspec.ValidationError: the value does not fit; nothing was changed.
            AttributeError: there is no such property.
        """
        entry = self.find(id)
        before = set(self.active())
        if entry and isinstance(entry.content, Runner):
            entry.content.set(path, value)
        elif entry and isinstance(entry.content, Group):
            set_property(entry.content, path, value)
        for runner in before - set(self.active()):
            runner.hide()

    def runners(self) -> list[Runner]:
        """Every display at work."""
        return [entry.content for entry in self._entries if isinstance(entry.content, Runner)]

    def active(self) -> list[Runner]:
        """The displays that neither they nor their groups switch off."""
        return [
            entry.content
            for entry in self._entries
            if isinstance(entry.content, Runner) and entry.is_enabled
        ]

    def read_again(self) -> None:
        """Show the entries that can be read now, since a plug-in has their type or property."""
        for index, entry in enumerate(self._entries):
            if isinstance(entry.content, Unreadable):
                item = config_file.read_display(entry.content.values, f"displays[{index}]")
                if isinstance(item, Unreadable):
                    entry.content = item
                elif not isinstance(item, Branch):
                    entry.content = Runner(entry.id, item, self._services)
        self._number()

    def items(self, parent: Entry | None = None) -> list[Item]:
        """What to save of a group, or of the whole list."""
        return [self._item(entry) for entry in self._entries if entry.parent is parent]

    def rows(self, statuses_of: Callable[[Runner], Mapping[str, Status]]) -> tuple[Row, ...]:
        """The list as a panel shows it; a group is as well as the worst display in it."""
        rows = [self._row(entry, statuses_of) for entry in self._entries]
        for index, entry in enumerate(self._entries):
            if isinstance(entry.content, Group) and entry.is_enabled:
                inner = [
                    row
                    for other, row in zip(self._entries, rows, strict=True)
                    if other is not entry and other.is_within(entry)
                ]
                rows[index] = replace(rows[index], statuses=_summary(inner))
        return tuple(rows)

    def _item(self, entry: Entry) -> Item:
        content = entry.content
        if isinstance(content, Group):
            return Branch(content, self.items(entry))
        return content.display if isinstance(content, Runner) else content

    def _row(self, entry: Entry, statuses_of: Callable[[Runner], Mapping[str, Status]]) -> Row:
        content, depth = entry.content, entry.depth
        if isinstance(content, Unreadable):
            status = {"Config": Status(Level.ERROR, content.reason)}
            return Row(entry.id, "", None, content.name, status, depth)
        if isinstance(content, Group):
            return Row(entry.id, "Group", content, content.name, {}, depth)
        statuses = statuses_of(content) if entry.is_enabled else {}
        name = type_name(type(content.display))
        return Row(entry.id, name, content.display, content.display.name, statuses, depth)

    def _insert(self, entry: Entry) -> None:
        """Put an entry behind the last one of its group."""
        index = len(self._entries)
        if entry.parent is not None:
            within = (i for i, e in enumerate(self._entries) if e.is_within(entry.parent))
            index = max(within) + 1
        self._entries.insert(index, entry)
        self._number()

    def _number(self) -> None:
        """Tell every display its place in the list."""
        for order, entry in enumerate(self._entries):
            if isinstance(entry.content, Runner):
                entry.content.order = order


def _summary(rows: Iterable[Row]) -> dict[str, Status]:
    """What a group says of what is in it: one line for each display that has a problem."""
    return {
        row.name: max(row.statuses.values(), key=lambda status: status.level)
        for row in rows
        if row.level is not Level.OK
    }
