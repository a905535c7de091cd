"""The tools, or the panels, of the config."""

from __future__ import annotations

import copy
import logging
from collections.abc import Mapping, Sequence
from typing import Any, Generic, cast

import msgspec

from webviz.api.declared import P, make, set_property
from webviz.api.registry import plugin_types
from webviz.api.status import Level, Status
from webviz.data.words import joined
from webviz.engine.parts.refusals import not_changed
from webviz.engine.parts.snapshots import Snapshot, made_anew, snapshot_of
from webviz.engine.pipeline.plugins import made_new
from webviz.files.config import ConfigError, Unreadable, nearest

log = logging.getLogger("webviz")


class PluginList(Generic[P]):
    """Tools or panels in order, each with an id.

    Args:
        base: what all of them are.
    """

    def __init__(self, base: type[P]) -> None:
        self._base = base
        self._types = plugin_types(base)
        self._items: dict[str, P | Unreadable] = {}
        self._count = 0

    def show(self, items: Sequence[P | Unreadable]) -> None:
        """Replace all of them."""
        self._items = {}
        for item in items:
            self.add(item)
            if isinstance(item, Unreadable):
                log.warning("%s", item.reason)

    def add(self, item: P | Unreadable) -> str:
        """Append one; returns its id."""
        self._count += 1
        id = f"{self._base.kind}{self._count}"
        self._items[id] = item
        return id

    def remove(self, name: str) -> str:
        """Remove one by its id or name; returns its name.

        Raises:
            ConfigError: there is none.
        """
        id, item = self.find(name)
        del self._items[id]
        return item.name

    def items(self) -> list[P | Unreadable]:
        """Return the items to save: a snapshot, for any thread."""
        return [copy.copy(item) for item in self._items.values()]

    def usable(self) -> dict[str, P]:
        """Usable plug-ins by id."""
        return {id: item for id, item in self._items.items() if isinstance(item, self._base)}

    def renew(self) -> None:
        """Use the classes of files that were loaded again, with the values of the old ones."""
        before, self._types = self._types, plugin_types(self._base)
        for id, item in self.usable().items():
            name = next((name for name, cls in before.items() if cls is type(item)), "")
            cls = self._types.get(name)
            if cls is None:
                del self._items[id]
            elif cls is not type(item):
                self._items[id], losses = made_new(item, cls)
                if losses:
                    log.warning("%s: values were dropped: %s.", item.name, "; ".join(losses))
        for name in self._types.keys() - before.keys():
            if getattr(self._types[name], "opens", "at start") == "at start":
                self.add(make(self._types[name], {}))

    def find(self, name: str) -> tuple[str, P]:
        """Id and item by its id or name.

        Raises:
            ConfigError: there is none.
        """
        usable = self.usable()
        ids = {item.name: id for id, item in usable.items()} | {id: id for id in usable}
        if name not in ids:
            names = [item.name for item in usable.values()]
            kind = self._base.kind
            raise ConfigError(f"Unknown {kind} `{name[:80]}`: {nearest(name, names)}")
        return ids[name], usable[ids[name]]

    def set(self, name: str, path: str, value: Any) -> None:
        """Change a property of one.

        Raises:
            ConfigError: there is no such item, or the value is invalid.
        """
        _, item = self.find(name)
        try:
            set_property(item, path, value)
        except msgspec.ValidationError as error:
            raise not_changed(error, type(item), path, value) from error

    def snapshots(self, before: Mapping[str, Snapshot]) -> dict[str, Snapshot]:
        """Return the undo snapshot, by id; unchanged ones are those from `before`."""
        return {id: snapshot_of(item, "", before.get(id)) for id, item in self._items.items()}

    def restore(self, snapshots: Mapping[str, Snapshot]) -> None:
        """Have those that were kept; those still there go on, with what they know."""
        now = self.snapshots({})
        self._items = {
            id: self._set_back(self._items[id], now[id], each)
            if id in now and now[id].class_ is each.class_
            else cast(P | Unreadable, made_anew(each))
            for id, each in snapshots.items()
        }

    def _set_back(self, item: P | Unreadable, now: Snapshot, target: Snapshot) -> P | Unreadable:
        """Return an item with its old properties."""
        if isinstance(item, Unreadable):
            return cast(Unreadable, target.content)
        for name, value in target.values.items():
            if now.values[name] != value:
                set_property(item, name, value)
        return item

    def statuses(self) -> Mapping[str, Status]:
        """Return the statuses of unusable ones."""
        faults = [item.reason for item in self._items.values() if isinstance(item, Unreadable)]
        key = f"{self._base.kind}s".capitalize()
        return {key: Status(Level.ERROR, joined(*faults))} if faults else {}
