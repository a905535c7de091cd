"""Panels without a viewer, which show the facts that a test gives them."""

from __future__ import annotations

from typing import Any, Generic, TypeVar

from msgspec.structs import replace

from webviz.api.panel import Panel
from webviz.engine.parts.panels import parameters_of
from webviz.engine.state import PanelTab, State
from webviz.page.recorded_ui import RecordedUi

P = TypeVar("P", bound=Panel)


def show(panel: Panel, state: State) -> None:
    """Let a panel show what it names of a state."""
    named = parameters_of(type(panel).show).items()
    panel.show(*(getattr(state, name, default) for name, default in named))


class LonePanel(Generic[P]):
    """A panel that is open, what its pages see, and the commands that it sends.

    Args:
        panel: not built yet.
        facts: fields of the state that it shows.
    """

    def __init__(self, panel: P, **facts: Any) -> None:
        self.panel = panel
        self.ui = RecordedUi()
        self.commands: list[Any] = []
        panel.build(self.ui, lambda command, browser=None: self.commands.append(command))
        self.state = State(panels=(PanelTab("id", "Panel", panel),), **facts)
        self.show()

    def show(self, **changes: Any) -> None:
        """Show the facts, of which some may have changed."""
        self.state = replace(self.state, **changes)
        show(self.panel, self.state)

    def values(self, number: int = 0) -> dict[str, Any]:
        """Return what a page is sent for a widget of its own kind, after showing the facts."""
        self.show()
        return self.ui.widgets[str(number)].values["values"]
