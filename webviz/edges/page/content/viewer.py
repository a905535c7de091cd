"""What holds for the viewer as a whole."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from webviz.edges.page.content.displays import level_name
from webviz.engine.state import State


def settings(state: State, _: str) -> Mapping[str, Any]:
    """Fixed frame, background, frame rate, saved views, and statuses."""
    settings = state.settings
    return {
        "fixed_frame": settings.fixed_frame,
        "background": settings.background,
        "frame_rate": settings.frame_rate,
        "views": list(settings.views),
        "statuses": [[key, level_name(s.level), s.text] for key, s in state.statuses.items()],
    }


def frames(state: State, _: str) -> Mapping[str, Any]:
    """All frame ids."""
    return {"frames": state.frames}


def file(state: State, _: str) -> Mapping[str, Any]:
    """The config file."""
    file = state.file
    return {
        "path": file.path,
        "is_changed": file.is_changed,
        "folder": file.folder,
        "others": file.others,
    }
