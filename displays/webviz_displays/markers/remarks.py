"""Remarks about markers that are not drawn as sent."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TypeVar

import msgspec

from webviz_displays.markers.actions import Key

REMEMBERED = 500
"""Markers of each kind; the last ones."""
SECOND = 1_000_000_000


class DeletedMarker(msgspec.Struct, frozen=True):
    """A marker that was there.

    Args:
        key: its namespace and id.
        how: "Expired" or "Deleted".
        at_ns: ROS time.
    """

    key: Key
    how: str
    at_ns: int

    def age(self, now_ns: int) -> str:
        """Return the time since then, as text."""
        seconds = max(0, now_ns - self.at_ns) / SECOND
        return f"{seconds:.0f} s ago" if seconds >= 1.0 else "just now"


class Remarks(msgspec.Struct):
    """Faults of markers, for statuses.

    Args:
        refused: why the newest version of a marker cannot be drawn.
        deletions: markers that were there, by their serial number.
        tilted: all markers whose orientation is not a unit quaternion.
        duplicates: of the last array.
        unknown_actions: of the last message that had any.
        overflow: how many markers were refused since there are too many.
    """

    refused: dict[Key, str] = msgspec.field(default_factory=dict)
    deletions: dict[int, DeletedMarker] = msgspec.field(default_factory=dict)
    tilted: set[Key] = msgspec.field(default_factory=set)
    duplicates: list[Key] = msgspec.field(default_factory=list)
    unknown_actions: list[int] = msgspec.field(default_factory=list)
    overflow: int = 0

    def refuse(self, key: Key, why: str) -> None:
        """Note that the newest version of a marker cannot be drawn."""
        _append(self.refused, key, why)

    def go(self, serial: int, marker: DeletedMarker) -> None:
        """Note that a marker has expired, or was deleted."""
        _append(self.deletions, serial, marker)

    def accept(self, keys: Iterable[Key | None]) -> None:
        """Markers have a new version that is valid."""
        if self.refused:
            for key in keys:
                if key is not None:
                    self.refused.pop(key, None)


K = TypeVar("K")
V = TypeVar("V")


def _append(remembered: dict[K, V], key: K, value: V) -> None:
    remembered.pop(key, None)
    remembered[key] = value
    if len(remembered) > REMEMBERED:
        del remembered[next(iter(remembered))]
