"""The properties of one tool."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from webviz.edges.page.content.forms import form, sendable, values_of
from webviz.engine.state import State


def tool(state: State, id_: str) -> Mapping[str, Any]:
    """Of the tool with this id, as `properties` has them of a display; nothing if it is gone."""
    button = next((button for button in state.tools if button.id == id_), None)
    if button is None:
        return {}
    cls = type(button.tool)
    declared = {
        "name": sendable(button.name),
        "type": cls.__name__,
        "declared": form(cls, ("name",)),
    }
    return declared | values_of(button.tool, ("name",))
