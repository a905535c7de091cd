"""Checks the values, files and forms that browsers send."""

from __future__ import annotations

import math
from typing import Any

import viser

from webviz.edges.scene.adapter.widgets import gui_input, gui_props, gui_value, has_form
from webviz.edges.scene.uploads import START

MAX_TEXT = 100_000


def accepts_update(server: viser.ViserServer, message: dict[str, Any]) -> bool:
    """Whether a message of a browser to a widget is valid.

    A GuiUpdateMessage may set only the value, to one that the widget allows. Files may be announced
    for upload buttons only. Changes of a form are relayed to other browsers and kept for those that
    join, so the form must be shared.
    """
    if message["type"] in ("GuiFormDirtyMessage", "GuiFormSubmitMessage"):
        return has_form(server, message["uuid"], shared=message["type"] == "GuiFormDirtyMessage")
    if message.get("type") == START:
        uuid = message.get("source_component_uuid")
        handle = gui_input(server, uuid) if isinstance(uuid, str) else None
        is_button = isinstance(handle, viser.GuiUploadButtonHandle)
        return is_button and not gui_props(handle).disabled
    updates = message.get("updates")
    uuid = message.get("uuid")
    if not isinstance(updates, dict) or set(updates) != {"value"} or not isinstance(uuid, str):
        return False
    handle = gui_input(server, uuid)
    return handle is not None and accepts_value(handle, updates["value"])


def accepts_value(handle: Any, value: Any) -> bool:
    """Whether a value matches the type, range, length and options of the widget."""
    props, current = gui_props(handle), gui_value(handle)
    if getattr(props, "disabled", False):
        return False
    if isinstance(handle, viser.GuiUploadButtonHandle):
        return False
    options = getattr(props, "options", None)
    if options is not None:
        return isinstance(value, str) and value in options
    if isinstance(handle, viser.GuiRgbHandle | viser.GuiRgbaHandle):
        return _fits_all(value, current, 0, 255)
    low, high = getattr(props, "min", None), getattr(props, "max", None)
    if isinstance(current, tuple):
        return _fits_all(value, current, low, high)
    return _fits(value, current, low, high)


def _fits_all(value: Any, current: tuple[Any, ...], low: Any, high: Any) -> bool:
    """Checks each element; limits are one for all elements, one per element, or None."""
    if not isinstance(value, list | tuple) or len(value) != len(current):
        return False
    lows = low if isinstance(low, tuple) else (low,) * len(current)
    highs = high if isinstance(high, tuple) else (high,) * len(current)
    return all(map(_fits, value, current, lows, highs))


def _fits(value: Any, current: Any, low: float | None, high: float | None) -> bool:
    if isinstance(current, bool):
        return isinstance(value, bool)
    if isinstance(current, str):
        return isinstance(value, str) and len(value) <= MAX_TEXT
    if isinstance(current, int | float):
        return (
            isinstance(value, int | float)
            and not isinstance(value, bool)
            and math.isfinite(value)
            and (isinstance(current, float) or value == int(value))
            and (low is None or value >= low)
            and (high is None or value <= high)
        )
    return False
