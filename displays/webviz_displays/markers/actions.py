"""Combined effect of the markers of one message."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

import msgspec
import numpy as np

from webviz.data.messages.markers import Marker, MarkerArray, MarkerSequence

Key = tuple[str, int]
"""Namespace and id: what a marker is known by."""


def name_of(key: Key) -> str:
    """Return a marker in texts."""
    return f"{key[0]}/{key[1]}"


class Effect(msgspec.Struct):
    """The net effect of a message: nothing is drawn before all its markers are processed.

    Args:
        added: the number in the message of the last version of each marker, by namespace and id.
        deleted: markers that are deleted, unless they are in `added` as well.
        deleted_namespaces: of which all markers are.
        deletes_all: whether all are.
        duplicates: markers that were added twice without being deleted in between.
        unknown: actions that there are not.
    """

    added: dict[str, dict[int, int]] = msgspec.field(default_factory=dict)
    deleted: set[Key] = msgspec.field(default_factory=set)
    deleted_namespaces: set[str] = msgspec.field(default_factory=set)
    deletes_all: bool = False
    duplicates: list[Key] = msgspec.field(default_factory=list)
    unknown: list[int] = msgspec.field(default_factory=list)

    def doomed(self, candidates: Collection[Key]) -> list[Key]:
        """Return the known markers that are deleted for good."""
        if self.deletes_all or self.deleted_namespaces:
            named = self.deleted_namespaces
            keys = [
                key
                for key in candidates
                if self.deletes_all or key[0] in named or key in self.deleted
            ]
        else:
            keys = [key for key in self.deleted if key in candidates]
        added = self.added
        return [key for key in keys if key[1] not in added.get(key[0], ())]


def deletes_all(message: Any, _: str) -> bool:
    """Return whether a Marker or MarkerArray deletes all markers before it."""
    if isinstance(message, MarkerArray):
        markers = message.markers
        deleted = np.flatnonzero(markers.actions == Marker.DELETEALL).tolist()
        return any(not markers.namespaces[i] for i in deleted)
    return message.action == Marker.DELETEALL and not message.ns


def effect_of(markers: MarkerSequence) -> Effect:
    """Return the net effect of the markers of one message, in order."""
    effect = Effect()
    namespaces, ids = markers.namespaces, markers.ids.tolist()
    actions = markers.actions
    ends = [*(np.flatnonzero(actions[1:] != actions[:-1]) + 1).tolist(), len(ids)]
    for start, stop in zip([0, *ends], ends, strict=False):
        if start == stop:
            continue  # no markers
        match int(actions[start]):
            case Marker.ADD:
                _add(effect, namespaces, ids, start, stop)
            case Marker.DELETE:
                for i in range(start, stop):
                    effect.added.get(namespaces[i], {}).pop(ids[i], None)
                    effect.deleted.add((namespaces[i], ids[i]))
            case Marker.DELETEALL:
                for namespace in dict.fromkeys(namespaces[start:stop]):
                    if namespace:
                        effect.added.pop(namespace, None)
                        effect.deleted_namespaces.add(namespace)
                    else:
                        effect.added.clear()
                        effect.deletes_all = True
            case other:
                effect.unknown.append(other)
    return effect


def _add(effect: Effect, namespaces: list[str], ids: list[int], start: int, stop: int) -> None:
    added, namespace = effect.added, namespaces[start]
    if namespace not in added and namespaces.count(namespace) == len(namespaces):
        numbers = dict(zip(ids[start:stop], range(start, stop), strict=True))
        if len(numbers) == stop - start:  # all of one namespace, as most arrays have them
            added[namespace] = numbers
            return
    for i in range(start, stop):
        same = added.get(namespaces[i])
        if same is None:
            same = added[namespaces[i]] = {}
        if ids[i] in same:
            effect.duplicates.append((namespaces[i], ids[i]))
        same[ids[i]] = i
