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

from webviz.api.nodes import Arrows, Axes, Image, Instances, Labels, Lines, Node, Points
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


def count_of(node: Node) -> int:
    """Return the number of items of a node whose items are selected one by one."""
    return len(getattr(node, fields(node)[0].name))


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
