"""The layout of the panels, and the saved ones."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from webviz.engine.state import State
from webviz.engine.store import PageStore
from webviz.page.content.forms import sendable


class SavedLayout(msgspec.Struct, frozen=True):
    """A saved layout: its name, and whether browsers show it."""

    name: str
    is_shown: bool


class DockedOnPage(msgspec.Struct, frozen=True):
    """A panel beside or below the scene."""

    panel: str
    weight: float


class FloatingOnPage(msgspec.Struct, frozen=True):
    """A panel over the scene."""

    panel: str
    left: float
    top: float
    width: float
    height: float


class LayoutStore(PageStore, frozen=True):
    """A layout, complete; see `webviz.files.config.layout`.

    Args:
        saved: the saved layouts.
        beside, below, over: the panels of each place.
        width, height: of the first two, in pixels.
    """

    saved: Sequence[SavedLayout]
    beside: Sequence[DockedOnPage]
    below: Sequence[DockedOnPage]
    over: Sequence[FloatingOnPage]
    width: float
    height: float


def layout(state: State, name: str) -> LayoutStore:
    """Return the layout that browsers show, or the saved one of this name if there is one."""
    settings = state.settings
    shown = settings.layouts.get(name, settings.layout)
    saved = [
        SavedLayout(str(sendable(each)), layout == settings.layout)
        for each, layout in settings.layouts.items()
    ]
    return LayoutStore(
        saved=saved,
        beside=[msgspec.convert(each, DockedOnPage, from_attributes=True) for each in shown.beside],
        below=[msgspec.convert(each, DockedOnPage, from_attributes=True) for each in shown.below],
        over=[msgspec.convert(each, FloatingOnPage, from_attributes=True) for each in shown.over],
        width=shown.width,
        height=shown.height,
    )
