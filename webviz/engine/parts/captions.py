"""Captions of what displays show outside of the tree: image panes and legends."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import ClassVar

import msgspec

from webviz.api.display import inputs
from webviz.api.nodes import Rgb
from webviz.api.status import Level
from webviz.engine.forms import brief, sendable
from webviz.engine.parts.visibility import enabled, hidden_in
from webviz.engine.state import Row
from webviz.engine.store import PageStore


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


class Scale(msgspec.Struct, frozen=True):
    """A colour scale, see `webviz.api.context.ColorScale`; bounds to four digits."""

    title: str
    label: str
    low: float
    high: float
    colors: Sequence[Rgb]


class LegendStore(PageStore, frozen=True):
    """The colour scales by display id."""

    spread: ClassVar = {"scales": ""}

    scales: Mapping[str, Scale]


class AttributionsStore(PageStore, frozen=True):
    """Whom to credit for what displays draw."""

    texts: Sequence[str]


def panes(rows: tuple[Row, ...]) -> PanesStore:
    """Return the captions of the panes of displays."""
    pane_rows = [row for row in enabled(rows) if row.display and type(row.display).has_pane]
    titled = titles(pane_rows)
    hidden = hidden_in(pane_rows, rows)
    about = {row.id: _caption(row, titled[row.id], hidden.get(row.id)) for row in pane_rows}
    return PanesStore([row.id for row in pane_rows], about)


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


def legend(rows: tuple[Row, ...]) -> LegendStore:
    """Return the colour scales of displays."""
    titled = titles(row for row in rows if row.color_scale is not None)
    return LegendStore(
        {
            row.id: Scale(
                title=titled[row.id],
                label=scale.label,
                low=float(f"{scale.low:.4g}"),
                high=float(f"{scale.high:.4g}"),
                colors=scale.colors,
            )
            for row in rows
            if (scale := row.color_scale) is not None
        }
    )


def titles(rows: Iterable[Row]) -> Mapping[str, str]:
    """Return the topic of each display by id, with its name if others of them have the same topic.

    A display without a topic has its name as title.
    """
    topics = {row.id: (_topic(row), row.name) for row in rows}
    count = Counter(topic for topic, _ in topics.values())
    return {id_: str(sendable(_title(*each, count[each[0]]))) for id_, each in topics.items()}


def _topic(row: Row) -> str:
    """Return the first topic of a display, "" if it has none."""
    named = (topic.name for _, _, topic in inputs(row.display)) if row.display else iter(())
    return next(filter(None, named), "")


def _title(topic: str, name: str, sharing: int) -> str:
    if not topic:
        return name
    return topic if sharing == 1 else f"{topic} ({name})"
