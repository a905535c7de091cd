"""What the page shows over the scene."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from webviz.engine.state import State


def legend(state: State, _: str) -> Mapping[str, Any]:
    """Which values colours stand for, by the id of the display; bounds to four digits."""
    return {
        row.id: {
            "name": row.name,
            "label": scale.label,
            "low": float(f"{scale.low:.4g}"),
            "high": float(f"{scale.high:.4g}"),
            "colors": scale.colors,
        }
        for row in state.rows
        if (scale := row.color_scale) is not None
    }


def watchers(state: State, _: str) -> Mapping[str, Any]:
    """How many browsers look at the scene."""
    return {"count": len(state.views)}
