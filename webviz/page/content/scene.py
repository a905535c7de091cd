"""Overlays of the scene."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import ClassVar

import msgspec

from webviz.api.nodes import Rgb
from webviz.engine.state import State
from webviz.engine.store import PageStore
from webviz.page.content.titles import titles


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


class WatchersStore(PageStore, frozen=True):
    """Number of browsers that watch the scene."""

    count: int


def legend(state: State, _: str) -> LegendStore:
    """Return the colour scales of displays."""
    titled = titles(row for row in state.rows if row.color_scale is not None)
    return LegendStore(
        {
            row.id: Scale(
                title=titled[row.id],
                label=scale.label,
                low=float(f"{scale.low:.4g}"),
                high=float(f"{scale.high:.4g}"),
                colors=scale.colors,
            )
            for row in state.rows
            if (scale := row.color_scale) is not None
        }
    )


def attributions(state: State, _: str) -> AttributionsStore:
    """Each credit once, in the order of the displays."""
    return AttributionsStore(
        tuple(dict.fromkeys(filter(None, (r.attribution for r in state.rows))))
    )


def watchers(state: State, _: str) -> WatchersStore:
    """Return the number of browsers that watch the scene."""
    return WatchersStore(len(state.views))
