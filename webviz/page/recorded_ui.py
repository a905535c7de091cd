"""A recording of the widgets of a panel."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypeVar

from webviz.api.chart import Remove, SeekTo
from webviz.api.panel import Act, Edit, Modifier
from webviz.page.chart import ChartWidget
from webviz.page.widgets import (
    AreaWidget,
    ButtonWidget,
    ChoiceWidget,
    CustomWidget,
    FieldWidget,
    Shortcut,
    SlidersWidget,
    Widget,
    clean,
)

_W = TypeVar("_W", bound=Widget)


class RecordedUi:
    """Records what a panel is built of; see `webviz.api.panel.Ui`."""

    def __init__(self) -> None:
        self.widgets: dict[str, Widget] = {}
        """In the order of the tab, by id."""
        self.commands: dict[str, Shortcut] = {}

    def find(self, id_: str) -> Widget | None:
        """Return a widget or command."""
        return self.widgets.get(id_) or self.commands.get(id_)

    def area(self) -> AreaWidget:
        """Add a place for text."""
        return self._add(AreaWidget())

    def button(self, label: str, act: Act, hint: str = "", width: float = 1.0) -> ButtonWidget:
        """Add a button."""
        return self._add(ButtonWidget(label, act, hint, max(0.1, min(1.0, width))))

    def checkbox(self, label: str, value: bool, edit: Edit, hint: str = "") -> FieldWidget:
        """Add a check box."""
        return self._add(FieldWidget("checkbox", label, bool(value), edit, hint))

    def field(self, label: str, value: str, edit: Edit, hint: str = "") -> FieldWidget:
        """Add a line of text."""
        return self._add(FieldWidget("field", label, clean(value), edit, hint))

    def choice(self, label: str, value: str, edit: Edit, hint: str = "") -> ChoiceWidget:
        """Add a list to choose from."""
        return self._add(ChoiceWidget(label, clean(value), edit, hint))

    def sliders(self, edit: Callable[[str, float, int | None], object]) -> SlidersWidget:
        """Add a place for sliders."""
        return self._add(SlidersWidget(edit))

    def chart(self, remove: Remove, seek: SeekTo | None = None) -> ChartWidget:
        """Add a chart."""
        return self._add(ChartWidget(remove, seek))

    def widget(
        self, kind: str, values: Mapping[str, Any], use: Callable[[Any, int | None], object]
    ) -> CustomWidget:
        """Add a widget of the panel's own module."""
        return self._add(CustomWidget(kind, values, use))

    def command(
        self, label: str, act: Act, key: str = "", modifier: Modifier | None = None
    ) -> None:
        """Add a command to the list, for every browser."""
        before = {None: "", "cmd/ctrl": "Ctrl+", "cmd/ctrl+shift": "Ctrl+Shift+"}[modifier]
        shortcut = Shortcut(label, act, f"{before}{key.lower()}" if key else "")
        self.commands[f"command-{len(self.commands)}"] = shortcut

    def _add(self, widget: _W) -> _W:
        self.widgets[str(len(self.widgets))] = widget
        return widget
