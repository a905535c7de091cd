"""Handles that pages can drag in the scene."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from webviz.api.handles import Control, Handle, MenuEntry
from webviz.engine.pipeline.gripping import reference_group
from webviz.engine.state import State
from webviz.page.content.forms import brief

MAX_HELP = 300
MAX_TITLE = 200


def handles(state: State, _: str) -> Mapping[str, Any]:
    """By the id of its display and its key, with a slash between, what a page needs of a handle.

    `frame` is the group of the scene that its pose is relative to, "" for the fixed frame; `holder`
    the browser that holds it, null for none.
    """
    return {
        f"{display}/{key}": _handle(display, handle, holder)
        for (display, key), (handle, holder) in state.handles.items()
    }


def _handle(display: str, handle: Handle, holder: int | None) -> Mapping[str, Any]:
    return {
        "name": brief(handle.name, MAX_TITLE),
        "frame": reference_group(display, handle.frame) if handle.frame else "",
        "controls": [_control(control) for control in handle.controls],
        "menu": _menu(handle.menu),
        "aids": handle.aids,
        "refusal": handle.refusal,
        "holder": holder,
    }


def _control(control: Control) -> Mapping[str, Any]:
    return {
        "mode": control.mode,
        "facing": control.facing,
        "wxyz": control.wxyz,
        "always": control.is_always_visible,
        "help": brief(control.help, MAX_HELP),
        "turned": control.turned,
    }


def _menu(entries: Iterable[MenuEntry]) -> list[Mapping[str, Any]]:
    return [
        {
            "id": entry.id,
            "title": brief(entry.title, MAX_TITLE),
            "checked": entry.is_checked,
            "refusal": entry.refusal,
            "entries": _menu(entry.entries),
        }
        for entry in entries
    ]
