"""View of one browser, and the saved views."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from webviz.api.views import VIEW_TYPES, type_of
from webviz.engine.state import State
from webviz.page.content.forms import form, sendable, values_of

DIGITS = 3
"""Decimals that are shown; a view moved by hand has more."""


def view(state: State, browser: str) -> Mapping[str, Any]:
    """Return a browser's view: "declared" and the values, rounded; all "types"."""
    shown = state.views.get(int(browser)) if browser.isdecimal() else None
    if shown is None:
        return {}
    values = {key: _rounded(value) for key, value in values_of(shown).items()}
    told = {"declared": form(type(shown)), "types": list(VIEW_TYPES), "value.type": type_of(shown)}
    return told | values


def views(state: State, _: str) -> Mapping[str, Any]:
    """The "saved" ones: name and type of each, and whether browsers begin with it."""
    settings = state.settings
    saved = [
        {"name": sendable(name), "type": type_of(view), "is_start": view == settings.view}
        for name, view in settings.views.items()
    ]
    return {"saved": saved}


def _rounded(value: Any) -> Any:
    """Numbers as they are shown; small ones keep digits that count."""
    if isinstance(value, list):
        return [_rounded(part) for part in value]
    if not isinstance(value, float):
        return value
    least = -math.floor(math.log10(abs(value))) if value else 0
    return round(value, max(DIGITS, min(least + 1, 6)))
