"""Overlays of the scene."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from webviz.engine.state import State
from webviz.page.content.titles import titles


def legend(state: State, _: str) -> Mapping[str, Any]:
    """Return the range of values of colour scales, by display id; bounds to four digits."""
    titled = titles(row for row in state.rows if row.color_scale is not None)
    return {
        row.id: {
            "title": titled[row.id],
            "label": scale.label,
            "low": float(f"{scale.low:.4g}"),
            "high": float(f"{scale.high:.4g}"),
            "colors": scale.colors,
        }
        for row in state.rows
        if (scale := row.color_scale) is not None
    }


def watchers(state: State, _: str) -> Mapping[str, Any]:
    """Return the number of browsers that watch the scene."""
    return {"count": len(state.views)}
