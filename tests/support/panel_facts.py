"""Panels without a viewer, which show the facts that a test gives them."""

from __future__ import annotations

from webviz.api.panel import Panel
from webviz.engine.parts.panels import parameters_of
from webviz.engine.state import State


def show(panel: Panel, state: State) -> None:
    """Let a panel show what it names of a state."""
    named = parameters_of(type(panel).show).items()
    panel.show(*(getattr(state, name, default) for name, default in named))
