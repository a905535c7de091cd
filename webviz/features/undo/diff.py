"""Moments of a config, and the text of the difference of two of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import msgspec

from webviz.api.properties import properties_of
from webviz.engine.parts.snapshots import ConfigOrigin, Snapshot
from webviz.files.config import Settings


class UndoSnapshot(msgspec.Struct, frozen=True):
    """All that undo brings back.

    Args:
        settings: of the config.
        displays: by id, in the order of the list.
        tools: by id, in the order of the toolbar.
        panels: by id, in the order of their tabs.
        origin: of all of them.
    """

    settings: Settings = msgspec.field(default_factory=Settings)
    displays: Mapping[str, Snapshot] = msgspec.field(default_factory=dict)
    tools: Mapping[str, Snapshot] = msgspec.field(default_factory=dict)
    panels: Mapping[str, Snapshot] = msgspec.field(default_factory=dict)
    origin: ConfigOrigin = ConfigOrigin()


class ConfigDiff(msgspec.Struct, frozen=True):
    """Actions between two snapshots.

    Args:
        label: in a few words, "" if nothing was.
        property: (id, name) if one property of one display or tool was changed, and nothing else;
            of a setting the id is "".
        removed: name of what was removed, "" if nothing was.
    """

    label: str
    property: tuple[str, str] | None = None
    removed: str = ""


def difference(before: UndoSnapshot, after: UndoSnapshot) -> ConfigDiff:
    """Return the actions between two snapshots.

    An entry that can be shown because its plug-in came is the same one.
    """
    path = after.origin.path
    if before.origin.path != path:
        return ConfigDiff(f"Open {path.name}" if path else "Open another config")
    lists = (
        (before.displays, after.displays),
        (before.tools, after.tools),
        (before.panels, after.panels),
    )
    for old, new in lists:
        removed = [entry for id, entry in old.items() if id not in new]
        come = [entry for id, entry in new.items() if id not in old]
        if removed and come:
            return ConfigDiff("Open another config")
        if removed:
            name = _outer(old, removed)
            return ConfigDiff(f"Remove {name}", removed=name)
        if come:
            return ConfigDiff(f"Add {_outer(new, come)}")
        changes = [(id, name) for id in new for name in _changed(old[id], new[id])]
        if changes:
            return _of_changes(new, changes)
    moved = _moved(before.displays, after.displays)
    if moved:
        return ConfigDiff(f"Move {moved}")
    return _of_settings(before.settings, after.settings)


def _outer(all_: Mapping[str, Snapshot], some: Sequence[Snapshot]) -> str:
    """Return the names of the outermost entries; those in a group go without saying."""
    groups = {id for id, entry in all_.items() if entry in some}
    outer = [entry.name for entry in some if entry.group not in groups]
    return outer[0] if len(outer) == 1 else f"{len(outer)} displays"


def _changed(old: Snapshot, new: Snapshot) -> list[str]:
    if old.class_ is None or new.class_ is None:
        return []
    return [name for name in new.values if old.values.get(name) != new.values[name]]


def _of_changes(new: Mapping[str, Snapshot], changes: list[tuple[str, str]]) -> ConfigDiff:
    ids = list(dict.fromkeys(id for id, _ in changes))
    if len(ids) > 1:
        return ConfigDiff(f"Change {len(ids)} displays")
    entry = new[ids[0]]
    if len(changes) > 1 or entry.class_ is None:
        return ConfigDiff(f"Change {entry.name}")
    name = changes[0][1]
    if name == "enabled":
        return ConfigDiff(f"{'Show' if entry.values[name] else 'Hide'} {entry.name}", changes[0])
    if name == "name":
        return ConfigDiff(f"Rename to {entry.name}", changes[0])
    labels = {each.path: each.label for each in properties_of(entry.class_)}
    return ConfigDiff(f"Change {labels.get(name, name)} of {entry.name}", changes[0])


def _moved(old: Mapping[str, Snapshot], new: Mapping[str, Snapshot]) -> str:
    """Return the name of what was moved, "" if nothing was."""
    for id, entry in new.items():
        if entry.group != old[id].group:
            return entry.name
    before, after = list(old), list(new)
    if before == after:
        return ""
    # Of two neighbours that changed places, either may have been moved: the first that stands
    # alone, without which the others are in the order they were in.
    for id in after:
        if [i for i in after if i != id] == [i for i in before if i != id]:
            return new[id].name
    return next(new[id].name for id, other in zip(after, before, strict=True) if id != other)


def _of_settings(old: Settings, new: Settings) -> ConfigDiff:
    if old.fixed_frame != new.fixed_frame:
        return ConfigDiff(f"Fixed frame {new.fixed_frame}")
    if old.views != new.views:
        return _of_saved("view", old.views, new.views)
    if old.layouts != new.layouts:
        return _of_saved("layout", old.layouts, new.layouts)
    labels = {
        "background": "background",
        "frame_rate": "frame rate",
        "layout": "layout",
        "view": "the view to start",
    }
    for name, label in labels.items():
        if getattr(old, name) != getattr(new, name):
            return ConfigDiff(f"Change {label}", ("", name))
    return ConfigDiff("" if old == new else "Change settings")


def _of_saved(kind: str, old: Mapping[str, object], new: Mapping[str, object]) -> ConfigDiff:
    removed, come = old.keys() - new.keys(), new.keys() - old.keys()
    if removed and come:
        return ConfigDiff(f"Rename {kind} {min(removed)}")
    if removed:
        name = f"{kind} {min(removed)}"
        return ConfigDiff(f"Remove {name}", removed=name)
    changed = come or {name for name in new if new[name] != old[name]}
    return ConfigDiff(f"Save {kind} {min(changed)}")
