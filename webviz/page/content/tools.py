"""The properties of one tool, and the vehicle that it drives."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from webviz.engine.state import State
from webviz.engine.store import PageStore
from webviz.page.content.forms import Form, form, sendable, values_of


class ToolStore(PageStore, frozen=True):
    """The properties of a tool, as `properties` has them of a display."""

    spread: ClassVar = {"values": "value."}

    name: str
    type: str
    declared: Form
    values: Mapping[str, Any]


class DrivingStore(PageStore, frozen=True):
    """A vehicle, see `webviz.engine.state.Driving`."""

    speed: float | None
    turn_rate: float | None
    problem: str


def tool(state: State, id_: str) -> ToolStore | None:
    """Properties of the tool with this id; None if it is gone."""
    button = next((button for button in state.tools if button.id == id_), None)
    if button is None:
        return None
    cls = type(button.tool)
    return ToolStore(
        name=str(sendable(button.name)),
        type=cls.__name__,
        declared=form(cls, ("name",)),
        values=values_of(button.tool, ("name",)),
    )


def driving(state: State, id_: str) -> DrivingStore | None:
    """Return the state of the vehicle of the tool with this id; None if no browser drives it."""
    found = state.driving.get(id_)
    if found is None:
        return None
    return DrivingStore(found.speed, found.turn_rate, str(sendable(found.problem)))
