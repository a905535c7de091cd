"""The properties of one tool, and the vehicle that it drives."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from webviz.engine.state import State
from webviz.page.content.forms import form, sendable, values_of


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


def driving(state: State, id_: str) -> Mapping[str, Any]:
    """Return the state of the vehicle of the tool with this id; empty if no browser drives it."""
    found = state.driving.get(id_)
    if found is None:
        return {}
    return {
        "speed": found.speed,
        "turn_rate": found.turn_rate,
        "problem": sendable(found.problem),
    }
