"""View of one browser, and the saved views."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

import msgspec

from webviz.api.views import VIEW_TYPES, type_of
from webviz.engine.state import State
from webviz.engine.store import PageStore
from webviz.page.content.forms import Form, form, sendable, values_of

DIGITS = 3
"""Decimals that are shown; a view moved by hand has more."""


class ViewStore(PageStore, frozen=True):
    """The view of a browser.

    Args:
        declared, values: of its properties, rounded, and "type".
        types: of views.
    """

    spread: ClassVar = {"values": "value."}

    declared: Form
    types: Sequence[str]
    values: Mapping[str, Any]


class SavedView(msgspec.Struct, frozen=True):
    """A saved view: its name and type, and whether browsers begin with it."""

    name: str
    type: str
    is_start: bool


class ViewsStore(PageStore, frozen=True):
    """The saved views."""

    saved: Sequence[SavedView]


def view(state: State, browser: str) -> ViewStore | None:
    """Return a browser's view; None before it has one."""
    shown = state.views.get(int(browser)) if browser.isdecimal() else None
    if shown is None:
        return None
    values = {key: _rounded(value) for key, value in values_of(shown).items()}
    return ViewStore(form(type(shown)), list(VIEW_TYPES), {"type": type_of(shown)} | values)


def views(state: State, _: str) -> ViewsStore:
    """Return the saved views."""
    settings = state.settings
    return ViewsStore(
        [
            SavedView(str(sendable(name)), type_of(view), view == settings.view)
            for name, view in settings.views.items()
        ]
    )


def _rounded(value: Any) -> Any:
    """Numbers as they are shown; small ones keep digits that count."""
    if isinstance(value, list):
        return [_rounded(part) for part in value]
    if not isinstance(value, float):
        return value
    least = -math.floor(math.log10(abs(value))) if value else 0
    return round(value, max(DIGITS, min(least + 1, 6)))
