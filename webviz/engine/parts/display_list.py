"""The displays of a viewer in their groups, in the order of the list."""

from __future__ import annotations

import contextlib
import copy
import itertools
import logging
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, TypeVar, cast

import msgspec

from webviz.api.declared import Topic, make, set_property, to_values
from webviz.api.display import Display
from webviz.api.group import DisplayGroup
from webviz.api.properties import FIRST
from webviz.engine.parts.entry import Entry
from webviz.engine.parts.refusals import not_changed
from webviz.engine.parts.snapshots import Snapshot, made_anew, snapshot_of
from webviz.engine.pipeline import DisplayServices, Runner
from webviz.files import config as config_file
from webviz.files import rviz
from webviz.files.config import Branch, ConfigError, Item, Location, Settings, Unreadable
from webviz.files.config.reading import MAX_DISPLAYS

D = TypeVar("D", bound=Display)


def copy_of(item: Item, names: set[str]) -> Item:
    """Return a copy of a display, or of a group with its contents, under an unused name.

    Args:
        item: to copy.
        names: of all displays.
    """
    copied = _copy(item)
    if not isinstance(copied, Unreadable):
        own = copied.group if isinstance(copied, Branch) else copied
        own.name = _fresh(own.name, names)
    return copied


def _copy(item: Item) -> Item:
    if isinstance(item, Branch):
        return Branch(_copied(item.group), [_copy(each) for each in item.displays])
    return copy.deepcopy(item) if isinstance(item, Unreadable) else _copied(item)


def _copied(display: D) -> D:
    return make(type(display), to_values(display))


def _fresh(name: str, names: set[str]) -> str:
    """Return an unused name: `Scan 2` for `Scan`."""
    stem = re.sub(r" \d+$", "", name)
    return next(n for i in itertools.count(2) if (n := f"{stem} {i}") not in names)


log = logging.getLogger("webviz")


class DisplayList:
    """All displays; each group precedes its contents.

    Args:
        services: for the runners.
    """

    def __init__(self, services: DisplayServices) -> None:
        self._services = services
        self._entries: list[Entry] = []
        self._count = 0
        self.aids: list[Runner] = []
        """Displays that the viewer adds for a while; no list or config has them."""

    @property
    def entries(self) -> Sequence[Entry]:
        """All lines in their order."""
        return self._entries

    def add(self, items: Iterable[Item], parent: Entry | None = None) -> list[Entry]:
        """Add displays, and groups with their contents, at the end of a group or the list.

        Returns:
            All new entries.

        Raises:
            ConfigError: the list has no room for all of them; nothing was added.
        """
        block = [entry for item in items for entry in self._made_of(item, parent)]
        self._make_room(len(block))
        self._insert(block, parent)
        return block

    def remove(self, id: str) -> None:
        """Remove a display, or a group with its contents."""
        if not (removed := self.find(id)):
            return
        for entry in self._entries:
            if entry.is_within(removed) and isinstance(entry.content, Runner):
                entry.content.close()
        self._entries = [entry for entry in self._entries if not entry.is_within(removed)]
        self._number()

    def clear(self) -> None:
        """Remove everything."""
        for runner in self.runners():
            runner.close()
        self._entries = []

    def duplicate(self, id: str) -> Entry | None:
        """Add a copy of a display, or of a group with its contents, after it, and return it.

        Raises:
            ConfigError: the list is full.
        """
        if not (original := self.find(id)):
            return None
        self._make_room(len(self.within(id)))
        names = {entry.declared.name for entry in self._entries}
        copied = copy_of(self._item(original), names)
        copied, *_ = self.add([copied], original.parent)
        siblings = [entry for entry in self._entries if entry.parent is original.parent]
        self.move(copied.id, _id(original.parent), siblings[siblings.index(original) + 1].id)
        return copied

    def move(self, id: str, group: str = "", before: str = "") -> None:
        """Move a display, or a group with its contents.

        Args:
            id: of the display or group.
            group: id of its new group; "" is the list itself.
            before: id of the entry of that group that follows it; "" is the end.
        """
        moved, parent, successor = self.find(id), self.group(group), self.find(before)
        if moved is None or moved is successor or (parent and parent.is_within(moved)):
            return
        block = [entry for entry in self._entries if entry.is_within(moved)]
        with self._hiding_disabled():
            self._entries = [entry for entry in self._entries if not entry.is_within(moved)]
            moved.parent = parent
            self._insert(block, parent, successor)

    def group(self, id: str) -> Entry | None:
        """Return the entry of an id if it is a group, else None."""
        entry = self.find(id)
        return entry if entry and isinstance(entry.content, DisplayGroup) else None

    def find(self, id: str) -> Entry | None:
        """Return the entry of an id, None if it is unknown."""
        return next((entry for entry in self._entries if entry.id == id), None)

    def within(self, id: str) -> list[str]:
        """Return the ids of a display or group and of its contents."""
        outer = self.find(id)
        return [entry.id for entry in self._entries if outer and entry.is_within(outer)]

    def set(self, id: str, path: str, value: Any) -> None:
        """Change a property of a display or a group.

        Raises:
            ConfigError: the value is invalid; nothing was changed.
            AttributeError: the property does not exist.
        """
        entry = self.find(id)
        if entry is None or isinstance(entry.declared, Unreadable):
            return
        entry.revision += 1
        try:
            with self._hiding_disabled():
                if isinstance(entry.content, Runner):
                    entry.content.set(path, value)
                else:
                    set_property(entry.declared, path, value)
        except msgspec.ValidationError as error:
            raise not_changed(error, type(entry.declared), path, value) from error

    def reset(self, id: str) -> None:
        """Give the properties of a display their defaults, but for its name, switch and topics."""
        entry = self.find(id)
        if entry is None or not isinstance(entry.content, Runner):
            return
        display = entry.content.display
        for name, default in msgspec.structs.asdict(type(display)()).items():
            value = getattr(display, name)
            if isinstance(value, Topic):
                default = msgspec.structs.replace(default, name=value.name)
            if name not in FIRST and value != default:
                self.set(id, name, default)

    def runners(self) -> list[Runner]:
        """Every running display."""
        return [entry.content for entry in self._entries if isinstance(entry.content, Runner)]

    def active(self) -> list[Runner]:
        """Return the displays that are enabled, and all groups they are in; then the aids."""
        return [
            entry.content
            for entry in self._entries
            if isinstance(entry.content, Runner) and entry.is_enabled
        ] + self.aids

    def read_again(self, settings: Settings) -> Settings:
        """Retry entries that could not be read, after a plug-in was loaded.

        Returns:
            The settings, with the parts of entries from RViz that only saving needs.
        """
        for index, entry in enumerate(self._entries):
            if isinstance(entry.content, Unreadable):
                item = config_file.read_display(entry.content.values, Location(("displays", index)))
                (item,), settings, report = rviz.revive([item], settings)
                for sentence in report.sentences():
                    log.warning("%s", sentence)
                if not isinstance(item, Branch):
                    entry.content = self._content(entry.id, item)
        self._number()
        return settings

    def written(self, ids: Iterable[str]) -> list[Item]:
        """Return the saved form of these displays and groups: a snapshot, for any thread."""
        chosen = [entry for entry in self._entries if entry.id in set(ids)]
        return [
            self._item(entry)
            for entry in chosen
            if not any(entry is not other and entry.is_within(other) for other in chosen)
        ]

    def items(self, parent: Entry | None = None) -> list[Item]:
        """Return the contents of a group or of the list to save: a snapshot, for any thread."""
        return [self._item(entry) for entry in self._entries if entry.parent is parent]

    def snapshots(self, before: Mapping[str, Snapshot]) -> dict[str, Snapshot]:
        """Return the undo snapshot of the entries, by id; unchanged ones come from `before`."""
        return {
            entry.id: snapshot_of(entry.declared, _id(entry.parent), before.get(entry.id))
            for entry in self._entries
        }

    def restore(self, snapshots: Mapping[str, Snapshot]) -> None:
        """Have the entries that were kept, in their order; those still there go on."""
        active = set(self.active())
        now = {entry.id: entry for entry in self._entries}
        for id in now.keys() - snapshots.keys():
            if isinstance(runner := now[id].content, Runner):
                active.discard(runner)
                runner.close()
        entries: dict[str, Entry] = {}
        for id, each in snapshots.items():
            if id in now:
                self._set_back(now[id], each)
            entry = entries[id] = now.get(id) or Entry(id, self._made_again(id, each))
            entry.parent = entries.get(each.group)
        self._entries = list(entries.values())
        self._number()
        for runner in active - set(self.active()):
            runner.hide()

    def _made_again(self, id: str, snapshot: Snapshot) -> Runner | DisplayGroup | Unreadable:
        own = made_anew(snapshot)
        if isinstance(own, DisplayGroup | Unreadable):
            return own
        return Runner(id, cast(Display, own), self._services)

    def _set_back(self, entry: Entry, snapshot: Snapshot) -> None:
        """Give an entry its old properties; one that could not be shown then stays as it is."""
        content = entry.content
        if isinstance(content, Unreadable):
            return
        for name, value in snapshot.values.items():
            # A plug-in that changed meanwhile may lack the property, or want other values.
            with contextlib.suppress(ConfigError, AttributeError):
                if msgspec.to_builtins(getattr(entry.declared, name)) != value:
                    self.set(entry.id, name, value)

    def _made_of(self, item: Item, parent: Entry | None) -> list[Entry]:
        """Return the entry of a display, or those of a group and its contents."""
        if isinstance(item, Unreadable) and not item.is_from_rviz:  # else it is in the report
            log.warning("%s", item.reason)
        self._count += 1
        id = f"display{self._count}"
        entry = Entry(id, self._content(id, item), parent)
        inner = item.displays if isinstance(item, Branch) else ()
        return [entry, *(below for each in inner for below in self._made_of(each, entry))]

    def _content(self, id: str, item: Item) -> Runner | DisplayGroup | Unreadable:
        content = item.group if isinstance(item, Branch) else item
        if isinstance(content, DisplayGroup | Unreadable):
            return content
        return Runner(id, content, self._services)

    @contextlib.contextmanager
    def _hiding_disabled(self) -> Iterator[None]:
        """Hide the displays that a change disables."""
        before = set(self.active())
        yield
        for runner in before - set(self.active()):
            runner.hide()

    def _make_room(self, more: int) -> None:
        if len(self._entries) + more > MAX_DISPLAYS:
            raise ConfigError(
                f"Not added: the limit is {MAX_DISPLAYS} displays. Remove some first."
            )

    def _item(self, entry: Entry) -> Item:
        copied = copy.copy(entry.declared)
        return Branch(copied, self.items(entry)) if isinstance(copied, DisplayGroup) else copied

    def _insert(
        self, block: list[Entry], parent: Entry | None, before: Entry | None = None
    ) -> None:
        """Insert entries before another of their group, or at its end."""
        index = len(self._entries)
        if before is not None and before.parent is parent:
            index = self._entries.index(before)
        elif parent is not None:
            index = max(i for i, e in enumerate(self._entries) if e.is_within(parent)) + 1
        self._entries[index:index] = block
        self._number()

    def _number(self) -> None:
        """Update the place of every display in the list."""
        for order, entry in enumerate(self._entries):
            if isinstance(entry.content, Runner):
                entry.content.order = order


def _id(entry: Entry | None) -> str:
    return entry.id if entry else ""
