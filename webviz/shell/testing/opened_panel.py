"""A panel of a viewer under test, without a page."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from webviz.api.panel import Panel
from webviz.commands import AddPanel, OpenPanels
from webviz.engine.commands import Command, Sender
from webviz.engine.loop import FrameLoop
from webviz.engine.parts.panels import PanelsPart
from webviz.page.recorded_ui import RecordedUi


class OpenedPanel:
    """A panel whose widgets can be read and used.

    Args:
        cls: of the panel.
        do: carries out a command of a browser.
        viewer: that has it.
        values: of its properties, for panels that are added on request.
    """

    def __init__(
        self,
        cls: type[Panel],
        do: Callable[[Command, Sender], object],
        viewer: FrameLoop,
        **values: Any,
    ) -> None:
        self._do = do
        self._viewer = viewer
        if cls.on_request:
            do(AddPanel(cls.__name__, values), Sender(None))
        do(OpenPanels(frozenset({cls.__name__})), Sender(None))
        tabs = viewer.get(PanelsPart).tabs()
        self.panel = next(tab.panel for tab in tabs if type(tab.panel) is cls)
        self.ui = RecordedUi()
        self.panel.build(self.ui, self.send)
        self.show()

    def send(self, command: Command, browser: int | None = None) -> None:
        """Send a command, as the panel does."""
        self._do(command, Sender(browser))

    def show(self) -> None:
        """Let it show the current state."""
        self._viewer.call(self._show).result()

    def _show(self) -> None:
        self._viewer.update()
        self._viewer.get(PanelsPart).show(self.panel)

    def widget(self, label: str) -> Any:
        """Return the widget with a label."""
        return next(w for w in self.ui.widgets.values() if w.values.get("label") == label)

    def use(self, label: str, value: Any = None, browser: int | None = None) -> None:
        """Press a button, or edit a field."""
        self.widget(label).use(value, browser)
        self.show()

    def text(self) -> str:
        """All texts and tables, after it has shown the current state."""
        self.show()
        areas = (w.values for w in self.ui.widgets.values() if w.values["kind"] == "area")
        return " ".join(map(str, areas))
