"""Charts as pages draw them: what they need at once, and the pieces of the curves."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from typing import Any

from webviz.api.chart import Chunk, Curve, Remove, SeekTo
from webviz.page.widgets import Widget, clean

MAX_CURVES = 32
MAX_TIME_S = 1e11
"""Of ROS time: beyond what 64 bits of nanoseconds hold."""


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
        self._made: dict[str, tuple[Chunk, Mapping[str, Any]]] = {}

    def show(
        self, curves: Sequence[Curve], window_s: float, now_s: float, across: str = ""
    ) -> None:
        """Show these curves."""
        shown = curves[:MAX_CURVES]
        self._keys = {
            curve.name: self._keys[curve.name] if curve.name in self._keys else next(self._count)
            for curve in shown
        }
        made: dict[str, tuple[Chunk, Mapping[str, Any]]] = {}
        facts = []
        for curve in shown:
            key = self._keys[curve.name]
            for chunk in curve.chunks:
                name = f"{key}.{chunk.number}"
                known = self._made.get(name)
                made[name] = known if known and known[0] is chunk else (chunk, _part(chunk))
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
        self._made = made
        self.parts = {name: part for name, (_, part) in made.items()}
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
            raise ValueError("This chart has no such time to go to.")
        self._seek(time_s, browser)


def _part(chunk: Chunk) -> Mapping[str, Any]:
    """Return a piece for JSON: times in microseconds precision from its start, None ends a line."""
    start = chunk.times_s[0] if chunk.times_s else 0.0
    return {
        "start": start,
        "times": [round(time - start, 6) for time in chunk.times_s],
        "values": [value if math.isfinite(value) else None for value in chunk.values],
    }
