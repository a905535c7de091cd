"""Displays kept from a .rviz file that have become supported."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import msgspec

from webviz.api.display import Display
from webviz.files.config import Branch, Item, Location, Settings, Unreadable
from webviz.files.rviz import values
from webviz.files.rviz.classes import counterpart
from webviz.files.rviz.displays import UnsupportedParts, read_items
from webviz.files.rviz.report import Report
from webviz.files.rviz.tree import MANAGER, Tree, child


def revive(items: Sequence[Item], settings: Settings) -> tuple[list[Item], Settings, Report]:
    """Return displays kept from a .rviz file, converted where their class is now supported.

    Args:
        items: of a config; other displays and unsupported ones stay unchanged.
        settings: of the config.

    Returns:
        The displays, the settings with their parts kept for export, and what was skipped.
    """
    report, unsupported = Report(), UnsupportedParts()
    revived = [_revived(item, report, unsupported) for item in items]
    if unsupported.entries:
        manager = child(settings.rviz, MANAGER)
        before = manager.get("Displays")
        manager["Displays"] = [*(before if isinstance(before, list) else []), *unsupported.entries]
        settings = msgspec.structs.replace(settings, rviz={**settings.rviz, MANAGER: manager})
    return revived, settings, report


def _revived(item: Item, report: Report, unsupported: UnsupportedParts) -> Item:
    if isinstance(item, Branch):
        return Branch(item.group, [_revived(each, report, unsupported) for each in item.displays])
    if not isinstance(item, Unreadable) or not item.is_from_rviz:
        return item
    entry = item.values["rviz"]
    cls = values.text(entry.get("Class", "")) if isinstance(entry, Mapping) else ""
    if counterpart(Display, cls) is None:
        return item
    (revived,) = read_items([_plain(entry)], report, unsupported, Location())
    return revived


def _plain(entry: Mapping) -> Tree:
    """Return an entry as read from the .rviz file, with keys as text."""
    return {str(key): _plain(v) if isinstance(v, Mapping) else v for key, v in entry.items()}
