"""Selected items of the scene, and the details their displays report.

def inspect(self, hit, ctx):
    wheel = hit.sample.message.wheels[hit.id]
    return Details(f"Wheel {hit.id}", {"Speed": f"{wheel.speed:.2f} m/s"})
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from webviz.api.nodes import Arrows, Axes, Image, Instances, Labels, Lines, Node, Points, Pose
from webviz.api.sample import Sample


@dataclass(frozen=True, eq=False)
class Hit:
    """One thing of what a display drew.

    Args:
        key: of the node.
        node: as it was on the screen.
        id: from the `ids` of the node, else the number of the point, segment, arrow, axes or solid
            in it; None for meshes and images.
        point: where it was clicked in metres, in the coordinates of a mesh or an image; otherwise
            the position of the item, in those of the node.
        frame: that the node moves with, or the frame of its sample; "" is the fixed frame.
        samples: that it was drawn from, oldest first.
    """

    key: str
    node: Node
    id: Any
    point: tuple[float, float, float]
    frame: str
    samples: Sequence[Sample]

    @property
    def sample(self) -> Sample:
        """The newest of the samples."""
        return self.samples[-1]


class Quantity(NamedTuple):
    """A number with its unit; of several selected items, pages show the extent and mean.

    Attributes:
        value: a float32 is shown with the digits that identify it.
        unit: such as "m".
    """

    value: float | np.generic
    unit: str


@dataclass(frozen=True)
class Details:
    """Details of a selected item.

    Args:
        title: what it is, such as "Point 12".
        values: by name, the most telling first: texts, numbers, quantities, arrays, poses,
            messages, or mappings of these. A float32 is shown with the digits that identify it.
    """

    title: str
    values: Mapping[str, object] = field(default_factory=dict)


@dataclass(frozen=True)
class Cells:
    """Reading of the cells of an image with a palette, where there is no display to ask.

    Args:
        corner: row and column of its first cell in the whole grid.
        columns: of the whole grid.
        resolution: edge of a cell in metres.
        origin: of the whole grid, in `frame`.
        frame: frame id.
        told: what is said about a cell, by its index in the palette.
    """

    corner: tuple[int, int]
    columns: int
    resolution: float
    origin: Pose
    frame: str
    told: Sequence[str | int]


class Column(NamedTuple):
    """A value of all items of a node.

    Attributes:
        values: (N,) or (N, K) numbers in the order of the items of the node.
        text: of a value, with a pair of braces for each of its K numbers.
    """

    values: NDArray[Any]
    text: str = "{}"


@dataclass(frozen=True, eq=False)
class Columns:
    """Details of all items of a node at once, where there is no display to ask.

    Args:
        title: of an item, with a pair of braces for its id.
        values: by name: columns, and texts that all items share.
        position: name of the value that an item has by its position.
        origin: that position is relative to this point, in metres.
    """

    title: str
    values: Mapping[str, Column | str] = field(default_factory=dict[str, Column | str])
    position: str = "Position"
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)


def count_of(node: Node) -> int:
    """Return the number of items of a node whose items are selected one by one."""
    return len(getattr(node, fields(node)[0].name))


def rows_of(node: Node) -> NDArray[np.intp]:
    """Return the ids of the items of a node, int (N,), which are their rows in the message."""
    ids = getattr(node, "ids", None)
    return np.arange(count_of(node)) if ids is None else ids


def noun_of(node: Node) -> str:
    """Return the noun for an item of a node."""
    if isinstance(node, Instances) and isinstance(node.shape, str):
        return node.shape.capitalize()
    return _NOUNS.get(type(node), "Mesh")


_NOUNS: Mapping[type, str] = {
    Points: "Point",
    Lines: "Line",
    Arrows: "Arrow",
    Axes: "Axes",
    Labels: "Text",
    Image: "Image",
}
