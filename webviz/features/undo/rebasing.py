"""Taking back one step of several people, which leaves what the others have done since."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import msgspec
from msgspec.structs import replace

from webviz.engine.parts.snapshots import Snapshot
from webviz.features.undo.diff import UndoSnapshot
from webviz.files.config import Settings


def rebased(now: UndoSnapshot, old: UndoSnapshot, new: UndoSnapshot) -> UndoSnapshot:
    """Apply to a snapshot what leads from one snapshot to another, and nothing else."""
    return UndoSnapshot(
        settings=_settings(now.settings, old.settings, new.settings),
        displays=_in_groups(_entries(now.displays, old.displays, new.displays)),
        tools=_entries(now.tools, old.tools, new.tools),
        panels=_entries(now.panels, old.panels, new.panels),
        origin=now.origin if old.origin == new.origin else new.origin,
    )


def _settings(now: Settings, old: Settings, new: Settings) -> Settings:
    changed = {
        name: getattr(new, name)
        for name in now.__struct_fields__
        if getattr(old, name) != getattr(new, name)
    }
    for key in ("views", "layouts"):
        if key in changed:
            changed[key] = _values(getattr(now, key), getattr(old, key), getattr(new, key))
    return msgspec.structs.replace(now, **changed)


def _values(
    now: Mapping[str, Any], old: Mapping[str, Any], new: Mapping[str, Any]
) -> dict[str, Any]:
    """Return a mapping with the changes of another: keys that went, came or have other values."""
    values = {key: value for key, value in now.items() if key in new or key not in old}
    return values | {k: value for k, value in new.items() if k not in old or old[k] != value}


def _entries(
    now: Mapping[str, Snapshot], old: Mapping[str, Snapshot], new: Mapping[str, Snapshot]
) -> dict[str, Snapshot]:
    entries_now: dict[str, Snapshot] = {}
    for id in {**now, **new}:
        if id not in new:
            if id not in old:
                entries_now[id] = now[id]
        elif id not in old or (id in now and now[id] == old[id]):
            entries_now[id] = new[id]
        elif id in now:
            entries_now[id] = _changed(now[id], old[id], new[id])
    was_moved = [id for id in old if id in new] != [id for id in new if id in old]
    base, others = (new, now) if was_moved else (now, new)
    order = _merged(
        (id for id in base if id in entries_now), [id for id in others if id in entries_now]
    )
    return {id: entries_now[id] for id in order}


def _changed(now: Snapshot, old: Snapshot, new: Snapshot) -> Snapshot:
    group = now.group if old.group == new.group else new.group
    if now.class_ is not new.class_ or old.class_ is not new.class_:
        return replace(now, group=group)
    return replace(now, values=_values(now.values, old.values, new.values), group=group)


def _merged(base: Iterable[str], others: list[str]) -> list[str]:
    """One order with the entries of another, each behind the one that it follows there."""
    order = list(base)
    at = 0
    for id in others:
        if id not in order:
            order.insert(at, id)
        at = order.index(id) + 1
    return order


def _in_groups(entries: Mapping[str, Snapshot]) -> dict[str, Snapshot]:
    """Entries in the order of a tree; those whose group is gone are in none."""
    below: dict[str, list[str]] = {}
    for id, each in entries.items():
        below.setdefault(each.group if each.group in entries else "", []).append(id)
    entries_now: dict[str, Snapshot] = {}

    def add(group: str) -> None:
        for id in below.pop(group, ()):
            each = entries[id]
            entries_now[id] = each if each.group == group else replace(each, group="")
            add(id)

    add("")
    for id in entries:  # groups in each other, which two people have made
        if id not in entries_now:
            entries_now[id] = replace(entries[id], group="")
            add(id)
    return entries_now
