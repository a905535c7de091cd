"""A recording of the widgets of a panel."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeVar

from webviz.api.chart import Chunk, Curve, Remove, SeekTo
from webviz.api.panel import Act, Edit, Modifier
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

MAX_CURVES = 32
MAX_TIME_S = 1e11
"""Largest ROS time in seconds: beyond it are more nanoseconds than 64 bits hold."""


class ChartWidget(Widget):
    """A chart; see `webviz.api.chart.Chart`.

    Args:
        remove: called with the name of a curve that a browser removes.
        seek: called with a time that a browser wants to go to; None if that is not possible.
    """

    def __init__(self, remove: Remove, seek: SeekTo | None = None) -> None:
        can_seek = seek is not None
        super().__init__(kind="chart", curves=[], window=1.0, now=0.0, across=-1, seeks=can_seek)
        self._remove = remove
        self._seek = seek
        self._keys: dict[str, int] = {}
        self._count = itertools.count()
        self._cache: dict[str, tuple[Chunk, Mapping[str, Any]]] = {}

    def show(
        self, curves: Sequence[Curve], window_s: float, now_s: float, across: str = ""
    ) -> None:
        """Show these curves."""
        limited = curves[:MAX_CURVES]
        self._keys = {
            curve.name: self._keys[curve.name] if curve.name in self._keys else next(self._count)
            for curve in limited
        }
        parts: dict[str, tuple[Chunk, Mapping[str, Any]]] = {}
        facts = []
        for curve in limited:
            key = self._keys[curve.name]
            for chunk in curve.chunks:
                name = f"{key}.{chunk.number}"
                cached = self._cache.get(name)
                parts[name] = cached if cached and cached[0] is chunk else (chunk, _part(chunk))
            numbers = [chunk.number for chunk in curve.chunks]
            facts.append(
                {
                    "key": key,
                    "name": clean(curve.name),
                    "problem": clean(curve.problem),
                    "axis": curve.axis,
                    "unit": clean(curve.unit),
                    "chunks": [numbers[0], numbers[-1] + 1] if numbers else [0, 0],
                }
            )
        self._cache = parts
        self.parts = {name: part for name, (_, part) in parts.items()}
        self.set(
            curves=facts, window=window_s, now=round(now_s, 3), across=self._keys.get(across, -1)
        )

    def use(self, value: Any, browser: int | None) -> None:
        """Remove a curve, or go to a time."""
        if value in self._keys:
            self._remove(value, browser)
            return
        try:
            time_s = float(value if isinstance(value, str) else "")
        except (TypeError, ValueError):
            raise ValueError("This curve has been removed already.") from None
        if self._seek is None or not abs(time_s) < MAX_TIME_S:
            raise ValueError("This time is outside of the chart. Choose another one.")
        self._seek(time_s, browser)


def _part(chunk: Chunk) -> Mapping[str, Any]:
    """Return a piece for JSON: times in microseconds precision from its start, None ends a line."""
    start = chunk.times_s[0] if chunk.times_s else 0.0
    return {
        "start": start,
        "times": [round(time - start, 6) for time in chunk.times_s],
        "values": [value if math.isfinite(value) else None for value in chunk.values],
    }


_W = TypeVar("_W", bound=Widget)


class RecordedUi:
    """Records what a panel is built of; see `webviz.api.panel.Ui`."""

    def __init__(self) -> None:
        self.widgets: dict[str, Widget] = {}
        """Widgets in the order of the tab, by id."""
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
