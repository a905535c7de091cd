"""Statistics of the items that a browser has selected, of each display."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import msgspec
import numpy as np

from webviz.api.picking import Quantity
from webviz.engine.pipeline.baking import Position

MAX_NAMES = 20
"""Values of one display of which there are statistics."""


class ValueRange(msgspec.Struct, frozen=True):
    """The extent of one value over several items.

    Args:
        name: of the value, such as "intensity".
        unit: "" if unknown.
        low, high, mean: of the finite ones.
    """

    name: str
    unit: str
    low: float
    high: float
    mean: float


class Statistics(msgspec.Struct):
    """Count and extents of the selected items of one display.

    Args:
        name: of the display.
        count: of its items.
    """

    name: str
    count: int = 0
    _values: dict[tuple[str, str], list[float]] = msgspec.field(default_factory=dict)

    def add(self, values: Mapping[str, object], position: tuple[str, Position] | None) -> None:
        """Add an item.

        Args:
            values: that the display has told of it; texts are left out.
            position: of the item in metres, and in which frame.
        """
        self.count += 1
        numbers: dict[str, tuple[float, str]] = {}
        if position is not None:
            frame, xyz = position
            numbers = {f"{a} in {frame}": (v, "m") for a, v in zip("xyz", xyz, strict=True)}
        for name, number in _numbers(values):
            numbers.setdefault(name, number)
        for name, (value, unit) in numbers.items():
            self._values.setdefault((name, unit), []).append(value)

    def ranges(self) -> list[ValueRange]:
        """Return the extents, but for numbers that are the same for all items."""
        ranges: list[ValueRange] = []
        for (name, unit), all_values in self._values.items():
            values = [value for value in all_values if math.isfinite(value)]
            is_told = len(values) > 1 and (unit or min(values) < max(values))
            if is_told and len(ranges) < MAX_NAMES:
                mean = math.fsum(value / len(values) for value in values)
                ranges.append(ValueRange(name, unit, min(values), max(values), mean))
        return ranges


def _numbers(
    values: Mapping[str, object], above: str = ""
) -> Iterator[tuple[str, tuple[float, str]]]:
    """All numbers with their units by name: "x in map" is the x of a "Position in map"."""
    for name, value in values.items():
        place = above.removeprefix("Position ")
        own = f"{name} {place}" if place != above else f"{above} {name}".strip()
        if isinstance(value, Mapping):
            inner: Mapping[str, object] = value
            yield from _numbers(inner, own)
        elif isinstance(value, bool | np.bool_):
            continue
        elif isinstance(value, int | float | np.integer | np.floating):
            yield own, (_real(value), "")
        elif isinstance(value, Quantity):
            yield own, (_real(value.value), value.unit)


def _real(value: float | np.generic) -> float:
    """Return an integer beyond all floats as infinite."""
    try:
        return float(value)
    except OverflowError:
        return math.inf
