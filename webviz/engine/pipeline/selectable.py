"""Details of everything that can be selected, for recordings that are shown without displays."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from webviz.api.frames import Frames
from webviz.api.nodes import Image, Node
from webviz.api.picking import Details, Quantity
from webviz.api.sample import Sample
from webviz.data.rotations import matrices
from webviz.data.transforms.errors import format_stamp
from webviz.engine.pipeline.details import details_tree
from webviz.engine.pipeline.picking import Found, every_item
from webviz.engine.pipeline.runner import Runner

MAX_ITEMS = 2000
"""Of one node; the details of larger clouds would take more room than their points."""
MAX_OF_DISPLAY = 4000
DIGITS = 4
"""Of numbers that are not integers: more would mostly be noise, which cannot be compressed."""

Values = Mapping[str, Any]
"""Of one node: "#frame", "#stamp", and columns with the titles, "#titles", and values of its items,
after a dot."""


class SelectableValues:
    """Keeps the details of all items, and makes anew those of what is drawn anew."""

    def __init__(self) -> None:
        self._made: dict[tuple[str, str], tuple[Node, Sequence[Sample], Values]] = {}

    def of(self, runner: Runner, frames: Frames) -> Mapping[str, Any]:
        """Return the details of a display, by group and key of its nodes and what it is, in lines.

        Args:
            runner: of the display.
            frames: at the time that is shown.
        """
        room = MAX_OF_DISPLAY
        told: dict[str, Any] = {}
        for name, key, node, samples, items in _nodes(runner):
            made = self._made.get((name, key))
            if isinstance(node, Image) and node.palette is not None:
                if made is None or made[0] is not node or made[1] is not samples:
                    values = _cell_values(runner, key, samples, frames)
                    made = self._made[name, key] = node, samples, values
                told |= {f"{name}\n{key}\n{what}": value for what, value in made[2].items()}
                continue
            # What has no message, or follows a frame, is another at each time.
            is_old = made is None or made[0] is not node or made[1] is not samples
            if is_old or not samples or any(each.placement.frame for each in items[:1]):
                room -= len(items)
                if not items or room < 0:
                    self._made.pop((name, key), None)
                    continue
                values = _values(runner, items, frames)
                made = self._made[name, key] = node, samples, values
            if made is not None:
                told |= {f"{name}\n{key}\n{what}": value for what, value in made[2].items()}
        return told


def _nodes(runner: Runner) -> Iterator[tuple[str, str, Node, Sequence[Sample], Sequence[Found]]]:
    for name, group, shot in runner.shots():
        for key, node in shot.groups[group].nodes.items():
            yield name, key, node, shot.samples, every_item(shot, group, key, MAX_ITEMS)


def _values(runner: Runner, items: Sequence[Found], frames: Frames) -> Values:
    details = [runner.inspect(each, frames) for each in items]
    known = [each for each in details if each is not None]
    if not known:
        return {}
    names = dict.fromkeys(name for each in known for name in each.values)
    hit = items[0].hit
    stamp_ns = hit.sample.stamp_ns if hit.samples else 0
    return {
        "#frame": hit.frame,
        "#stamp": f"{format_stamp(stamp_ns)} s" if stamp_ns else "",
        "#titles": _column(_titles(details)),
        **{f".{name}": _values_column(name, details) for name in names},
    }


def _cell_values(runner: Runner, key: str, samples: Sequence[Sample], frames: Frames) -> Values:
    """Return how the cells of an image are read: their values are in it."""
    cells = runner.cells(key, frames)
    if cells is None:
        return {}
    along, across, _ = matrices(cells.origin.wxyz).T.tolist()
    grid = {
        "corner": cells.corner,
        "columns": cells.columns,
        "resolution": cells.resolution,
        "origin": cells.origin.position,
        "axes": [along, across],
        "frame": cells.frame,
        "told": cells.told,
    }
    stamp_ns = samples[-1].stamp_ns if samples else 0
    stamp = f"{format_stamp(stamp_ns)} s" if stamp_ns else ""
    return {"#frame": cells.frame, "#stamp": stamp, "#cells": grid}


def _titles(details: Iterable[Details | None]) -> list[str | None]:
    return [each.title if each else None for each in details]


def _values_column(name: str, details: Sequence[Details | None]) -> Mapping[str, Any]:
    """Return a value of all items, None of those that do not have it."""
    values = [_rounded(each.values.get(name)) if each else None for each in details]
    numbers = [each.value if isinstance(each, Quantity) else each for each in values]
    units = {each.unit if isinstance(each, Quantity) else "" for each in values}
    is_float = all(isinstance(each, float) and math.isfinite(each) for each in numbers)
    if is_float and len(units) == 1 and len(numbers) > 1:
        # Units and quotes would double the size of the file.
        return {"numbers": numbers, "unit": units.pop()}
    trees = [None if each is None else details_tree({name: each}) for each in values]
    return _column([tree and next(iter(tree["fields"].values()), None) for tree in trees])


def _column(values: Sequence[Any]) -> Mapping[str, Any]:
    """Return the values of all items, or the one that all have."""
    first = values[0]
    if all(each == first for each in values):
        return {"all": first}
    return {"each": values}


def _rounded(value: Any) -> Any:
    """Numbers with the digits that are kept, in whatever holds them."""
    match value:
        case Quantity():
            return Quantity(_rounded(value.value), value.unit)
        case Mapping():
            return {name: _rounded(each) for name, each in value.items()}
        case float() | np.floating():
            return float(f"{value:.{DIGITS}g}")
        case _:
            return value
