"""Details of everything that can be selected, for recordings that are shown without displays."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import msgspec
import numpy as np

from webviz.api.frames import Frames
from webviz.api.nodes import Node
from webviz.api.picking import Details, Quantity
from webviz.api.sample import Sample
from webviz.data.transforms.errors import format_stamp
from webviz.engine.pipeline.details import details_tree
from webviz.engine.pipeline.picking import PickedItem, every_item
from webviz.engine.pipeline.runner import Runner

MAX_ITEMS = 2000
"""Largest number of items of one node; those of larger nodes are left out."""
MAX_OF_DISPLAY = 4000
DIGITS = 4
"""Number of digits of numbers that are not integers: more would mostly be noise, which cannot be
compressed."""

Values = Mapping[str, Any]
"""Values of one node: "#frame", "#stamp", and columns with the titles, "#titles", and values of its
items, after a dot."""


class _SelectableNode(msgspec.Struct, frozen=True):
    """A node that is drawn.

    Args:
        path: group and key, in lines.
        key: of the node.
        node: itself.
        samples: that it was drawn from.
        frame: that it moves with, or the frame of its sample.
        is_moving: whether its items are others at each time.
        items: all, if these are not too many.
    """

    path: str
    key: str
    node: Node
    samples: Sequence[Sample]
    frame: str
    is_moving: bool
    items: Sequence[PickedItem]

    def is_in(self, other: _SelectableNode) -> bool:
        """Return whether another one is drawn alike."""
        return self.node is other.node and self.samples is other.samples


class SelectableValues:
    """Keeps the details of all items, and makes anew those of what is drawn anew."""

    def __init__(self) -> None:
        self._cache: dict[str, dict[str, tuple[_SelectableNode, Values]]] = {}

    def of(self, runner: Runner, frames: Frames) -> Mapping[str, Any]:
        """Return the details of a display, by group and key of its nodes and what it is, in lines.

        Args:
            runner: of the display.
            frames: at the time that is shown.
        """
        room = MAX_OF_DISPLAY
        before = self._cache.get(runner.id, {})
        entries: dict[str, tuple[_SelectableNode, Values]] = {}
        for node in _nodes(runner):
            entry = before.get(node.path)
            if entry and node.is_in(entry[0]) and not (node.is_moving and node.items):
                entries[node.path] = entry
            elif node.items and len(node.items) <= room:
                room -= len(node.items)
                entries[node.path] = node, _values(runner, node, frames)
            elif node.samples:
                entries[node.path] = node, {"#frame": node.frame, "#stamp": _stamp(node)}
        self._cache[runner.id] = entries
        return {
            f"{path}\n{what}": value
            for path, (_, values) in entries.items()
            for what, value in values.items()
        }


def _nodes(runner: Runner) -> Iterator[_SelectableNode]:
    for name, group, snapshot in runner.scene_diff.snapshots():
        frame = snapshot.groups[group].placement.frame
        own = snapshot.samples[-1].frame if snapshot.samples else ""
        for key, node in snapshot.groups[group].nodes.items():
            items = every_item(snapshot, group, key, MAX_ITEMS)
            is_moving = frame is not None or not snapshot.samples
            yield _SelectableNode(
                f"{name}\n{key}", key, node, snapshot.samples, frame or own, is_moving, items
            )


def _values(runner: Runner, node: _SelectableNode, frames: Frames) -> Values:
    details = [runner.inspect(each, frames) for each in node.items]
    readable = [each for each in details if each is not None]
    if not readable:
        return {}
    names = dict.fromkeys(name for each in readable for name in each.values)
    return {
        "#frame": node.frame,
        "#stamp": _stamp(node),
        "#titles": _column(_titles(details)),
        **{f".{name}": _values_column(name, details) for name in names},
    }


def _stamp(node: _SelectableNode) -> str:
    stamp_ns = node.samples[-1].stamp_ns if node.samples else 0
    return f"{format_stamp(stamp_ns)} s" if stamp_ns else ""


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
