"""Snapshots of what a config lists, and where it comes from, to bring them back."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import msgspec

from webviz.api.declared import Declared, make
from webviz.files.config import Template, Unreadable


class Snapshot(msgspec.Struct, frozen=True):
    """One entry of the list of displays, one tool or one panel.

    Args:
        class_: of the display, group, tool or panel; None for an entry that cannot be shown.
        values: all of its properties as plain values.
        content: to make it again from: the entry itself if it cannot be shown, else None.
        group: id of the group it is in, "" for none.
    """

    class_: type[Declared] | None
    values: Mapping[str, Any]
    content: Unreadable | None = None
    group: str = ""

    @property
    def name(self) -> str:
        """Name that people see."""
        return self.content.name if self.content else str(self.values["name"])


def snapshot_of(content: Declared | Unreadable, group: str, before: Snapshot | None) -> Snapshot:
    """Return a snapshot of an entry.

    The one from before if it is still the same, to save memory.
    """
    if isinstance(content, Unreadable):
        now = Snapshot(None, {}, content, group)
    else:
        now = Snapshot(type(content), msgspec.to_builtins(content), None, group)
    return before if now == before and before is not None else now


def made_anew(snapshot: Snapshot) -> Declared | Unreadable:
    """Return the declared object of a snapshot, made anew."""
    if snapshot.class_ is None:
        assert snapshot.content is not None
        return snapshot.content
    return make(snapshot.class_, dict(snapshot.values))


class ConfigOrigin(msgspec.Struct, frozen=True):
    """The source of a config.

    Args:
        path: of the config file, None for none.
        report: what the .rviz file has that webviz does not support.
        templates: see `webviz.files.config.Config`.
    """

    path: Path | None = None
    report: Sequence[str] = ()
    templates: tuple[Template, ...] = ()
