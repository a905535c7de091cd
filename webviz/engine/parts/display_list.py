"""The displays of a viewer in their groups, in the order of the list."""

from __future__ import annotations

import copy
import itertools
import logging
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any, TypeVar

import msgspec

from webviz.api.declared import make, set_property, to_values
from webviz.api.display import Display
from webviz.api.group import Group
from webviz.api.registry import type_name
from webviz.api.status import Level, Status
from webviz.engine.parts.refusals import not_changed
from webviz.engine.pipeline import Runner, Services
from webviz.engine.state import Row
from webviz.files import config as config_file
from webviz.files import rviz
from webviz.files.config import Branch, ConfigError, Item, Location, Settings, Unreadable
from webviz.files.config.reading import MAX_DISPLAYS

log = logging.getLogger("webviz")

D = TypeVar("D", bound=Display)


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
    def name(self) -> str:
        """As shown in the list."""
        return self.content.display.name if isinstance(self.content, Runner) else self.content.name

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

    def add(self, item: Item, parent: Entry | None = None) -> Entry:
        """Add a display, or a group with all that is in it, at the end of a group or the list.

        Raises:
            ConfigError: there are too many.
        """
        self._make_room(1)
        self._made += 1
        id = f"display{self._made}"
        if isinstance(item, Branch):
            entry = Entry(id, item.group, parent)
        elif isinstance(item, Unreadable):
            if not item.is_from_rviz:  # those are in the report on the whole file
                log.warning("%s", item.reason)
            entry = Entry(id, item, parent)
        elif isinstance(item, Group):
            entry = Entry(id, item, parent)
        else:
            entry = Entry(id, Runner(id, item, self._services), parent)
        self._insert([entry], parent)
        if isinstance(item, Branch):
            for each in item.displays:
                self.add(each, entry)
        return entry

    def remove(self, id: str) -> None:
        """Remove a display, or a group with all that is in it."""
        if not (gone := self.find(id)):
            return
        for entry in self._entries:
            if entry.is_within(gone) and isinstance(entry.content, Runner):
                entry.content.close()
        self._entries = [entry for entry in self._entries if not entry.is_within(gone)]
        self._number()

    def clear(self) -> None:
        """Remove everything."""
        for runner in self.runners():
            runner.close()
        self._entries = []

    def duplicate(self, id: str) -> Entry | None:
        """Add a copy right behind a display, or a group with all that is in it, and return it.

        Raises:
            ConfigError: there are too many.
        """
        if not (original := self.find(id)):
            return None
        self._make_room(len(self.within(id)))
        copied = _copy(self._item(original))
        names = {entry.name for entry in self._entries}
        if not isinstance(copied, Unreadable):
            own = copied.group if isinstance(copied, Branch) else copied
            own.name = _fresh(own.name, names)
        twin = self.add(copied, original.parent)
        siblings = [entry for entry in self._entries if entry.parent is original.parent]
        self.move(twin.id, _id(original.parent), siblings[siblings.index(original) + 1].id)
        return twin

    def move(self, id: str, group: str = "", before: str = "") -> None:
        """Put a display, or a group with all that is in it, elsewhere.

        Args:
            id: what to move.
            group: where to; "" is the list itself.
            before: goes before this one of that group; "" is the end.
        """
        moved, parent, successor = self.find(id), self.group(group), self.find(before)
        if moved is None or moved is successor or (parent and parent.is_within(moved)):
            return
        block = [entry for entry in self._entries if entry.is_within(moved)]
        shown = set(self.active())
        self._entries = [entry for entry in self._entries if not entry.is_within(moved)]
        moved.parent = parent
        self._insert(block, parent, successor)
        for runner in shown - set(self.active()):
            runner.hide()

    def group(self, id: str) -> Entry | None:
        """The entry of an id, if it is a group; nothing else can hold displays."""
        entry = self.find(id)
        return entry if entry and isinstance(entry.content, Group) else None

    def find(self, id: str) -> Entry | None:
        """The entry of an id."""
        return next((entry for entry in self._entries if entry.id == id), None)

    def within(self, id: str) -> list[str]:
        """The ids of a display or group and of all that is in it."""
        outer = self.find(id)
        return [entry.id for entry in self._entries if outer and entry.is_within(outer)]

    def set(self, id: str, path: str, value: Any) -> None:
        """Change a property of a display or a group.

        Raises:
            ConfigError: the value does not fit; nothing was changed.
            AttributeError: there is no such property.
        """
        entry = self.find(id)
        content = entry.content if entry else None
        before = set(self.active())
        try:
            if isinstance(content, Runner):
                content.set(path, value)
            elif isinstance(content, Group):
                set_property(content, path, value)
        except msgspec.ValidationError as error:
            own = content.display if isinstance(content, Runner) else content
            raise not_changed(error, type(own), path, value) from error
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

    def read_again(self, settings: Settings) -> Settings:
        """Show the entries that can be read now, since a plug-in has their type or property.

        Returns:
            The settings, with what is kept of entries that came from RViz for writing them again.
        """
        for index, entry in enumerate(self._entries):
            if isinstance(entry.content, Unreadable):
                item = config_file.read_display(entry.content.values, Location(("displays", index)))
                (item,), settings, report = rviz.revive([item], settings)
                for sentence in report.sentences():
                    log.warning("%s", sentence)
                if isinstance(item, Unreadable):
                    entry.content = item
                elif not isinstance(item, Branch):
                    entry.content = Runner(entry.id, item, self._services)
        self._number()
        return settings

    def items(self, parent: Entry | None = None) -> list[Item]:
        """What to save of a group, or of the whole list: a snapshot, for any thread."""
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

    def _make_room(self, more: int) -> None:
        if len(self._entries) + more > MAX_DISPLAYS:
            raise ConfigError(
                f"Not added: the limit is {MAX_DISPLAYS} displays. Remove some first."
            )

    def _item(self, entry: Entry) -> Item:
        content = entry.content
        if isinstance(content, Group):
            return Branch(copy.copy(content), self.items(entry))
        return copy.copy(content.display) if isinstance(content, Runner) else content

    def _row(self, entry: Entry, statuses_of: Callable[[Runner], Mapping[str, Status]]) -> Row:
        content, depth = entry.content, entry.depth
        if isinstance(content, Unreadable):
            status = {"Config": Status(Level.ERROR, content.reason)}
            return Row(entry.id, "", None, entry.name, status, depth, content.enabled)
        if isinstance(content, Group):
            return Row(entry.id, "Group", content, content.name, {}, depth, content.enabled)
        statuses = statuses_of(content) if entry.is_enabled else {}
        display = content.display
        name = type_name(type(display))
        return Row(entry.id, name, display, display.name, statuses, depth, display.enabled)

    def _insert(
        self, block: list[Entry], parent: Entry | None, before: Entry | None = None
    ) -> None:
        """Put entries before one of their group, or behind the last one."""
        index = len(self._entries)
        if before is not None and before.parent is parent:
            index = self._entries.index(before)
        elif parent is not None:
            index = max(i for i, e in enumerate(self._entries) if e.is_within(parent)) + 1
        self._entries[index:index] = block
        self._number()

    def _number(self) -> None:
        """Tell every display its place in the list."""
        for order, entry in enumerate(self._entries):
            if isinstance(entry.content, Runner):
                entry.content.order = order


def _copy(item: Item) -> Item:
    if isinstance(item, Branch):
        return Branch(_copied(item.group), [_copy(each) for each in item.displays])
    return copy.deepcopy(item) if isinstance(item, Unreadable) else _copied(item)


def _copied(display: D) -> D:
    return make(type(display), to_values(display))


def _fresh(name: str, taken: set[str]) -> str:
    """A name that nothing has: `Scan`, then `Scan 2`."""
    stem = re.sub(r" \d+$", "", name)
    return next(n for i in itertools.count(2) if (n := f"{stem} {i}") not in taken)


def _id(entry: Entry | None) -> str:
    return entry.id if entry else ""


def _summary(rows: Iterable[Row]) -> dict[str, Status]:
    """What a group says of what is in it: one line for each display that has a problem."""
    return {
        row.name: max(row.statuses.values(), key=lambda status: status.level)
        for row in rows
        if row.level is not Level.OK
    }
