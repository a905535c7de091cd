"""Displays visible where the scene is drawn with another camera: image panes and 3D scenes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from webviz.api.group import PATH
from webviz.api.properties import Property, properties_of
from webviz.engine.state import Row

MAX_NAMES = 1000
"""Displays that get a switch in the page."""


def paths(rows: Sequence[Row]) -> Iterator[tuple[Row, str]]:
    """Each row, with the names of its groups before its own."""
    groups: list[str] = []
    for row in rows:
        groups[row.depth :] = [row.name]
        yield row, PATH.join(groups)


def enabled(rows: Iterable[Row]) -> Iterator[Row]:
    """Yield the rows that are on, and not in a group that is off."""
    off: int | None = None
    for row in rows:
        if off is None or row.depth <= off:
            off = None if row.enabled else row.depth
            if row.enabled:
                yield row


def names(rows: Sequence[Row], own: Row | None = None) -> Mapping[str, str]:
    """Return the names of switches, and the type of each display; its own display has none."""
    types = {path: row.type for row, path in paths(rows) if row is not own}
    return dict(list(types.items())[:MAX_NAMES])


def switches_of(row: Row) -> list[Property]:
    """Return the properties of a display with switches of the others."""
    if row.display is None:
        return []
    return [each for each in properties_of(type(row.display)) if each.widget == "displays"]


def hidden_in(panes: Iterable[Row], rows: Sequence[Row]) -> dict[str, list[str]]:
    """Ids of the displays that a pane leaves out, by its own; only those that draw the scene."""
    hidden_by_row: dict[str, list[str]] = {}
    for row in panes:
        for each in switches_of(row):
            assert row.display is not None
            hidden_by_row[row.id] = hidden(rows, each.of(row.display))
    return hidden_by_row


def hidden(rows: Sequence[Row], switches: Mapping[str, bool]) -> list[str]:
    """Return the ids of the displays that are switched off, by themselves or with a group."""
    ids: list[str] = []
    off: int | None = None
    for row, path in paths(rows):
        if off is not None and row.depth <= off:
            off = None
        if off is None and not switches.get(path, True):
            off = row.depth
        if off is not None:
            ids.append(row.id)
    return ids
