"""The pictures beside the scene."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import ClassVar

import msgspec

from webviz.api.status import Level
from webviz.engine.state import Row, State
from webviz.engine.store import PageStore
from webviz.page.content.forms import brief, sendable
from webviz.page.content.titles import titles
from webviz.page.content.visibility import enabled, hidden_in


class PaneCaption(msgspec.Struct, frozen=True):
    """The caption of a pane.

    Args:
        title: its topic, or the name of its display.
        name: of its display.
        problem: the first of the worst statuses, "" for none.
        has_picture: whether there is one.
        hidden: ids of the displays that are left out; unset if it does not draw the scene.
    """

    title: str
    name: str
    problem: str
    has_picture: bool
    hidden: Sequence[str] | msgspec.UnsetType = msgspec.UNSET


class PanesStore(PageStore, frozen=True):
    """The captions of panes.

    Args:
        order: ids of their displays.
        panes: by the id of their display.
    """

    spread: ClassVar = {"panes": ""}

    order: Sequence[str]
    panes: Mapping[str, PaneCaption]


def panes(state: State, _: str) -> PanesStore:
    """Return the captions of panes."""
    rows = [row for row in enabled(state.rows) if row.display and type(row.display).has_pane]
    titled = titles(rows)
    hidden = hidden_in(rows, state.rows)
    about = {row.id: _caption(row, titled[row.id], hidden.get(row.id)) for row in rows}
    return PanesStore([row.id for row in rows], about)


def _caption(row: Row, title: str, hidden: Sequence[str] | None) -> PaneCaption:
    level = row.level
    problem = ""
    if level > Level.OK:
        problem = next(status.text for status in row.statuses.values() if status.level is level)
    return PaneCaption(
        title=title,
        name=str(sendable(row.name)),
        problem=brief(problem),
        has_picture=level is not Level.ERROR,
        hidden=msgspec.UNSET if hidden is None else hidden,
    )
