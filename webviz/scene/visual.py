"""The base of all primitives: a node of a group, drawn by one or more viser nodes."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Any, Generic, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray
from viser import SceneApi, SceneNodeHandle

from webviz.api.nodes import U8, Rgb, same
from webviz.scene.adapter import Adapter

OPACITY_BIT = 40
"""Binary place of the opacity in widths and sizes: far below what float32 resolves."""

Props = dict[str, Any]
NodeT = TypeVar("NodeT")
NodeT_contra = TypeVar("NodeT_contra", contravariant=True)


class NodeVisual(Protocol[NodeT_contra]):
    """A node in the browsers."""

    def draw(self, node: NodeT_contra) -> None:
        """Send the changes since the last call."""
        ...

    def remove(self) -> None:
        """Remove it from the scene."""
        ...


class SingleNode(ABC, Generic[NodeT]):
    """A primitive that is one viser node.

    It is created empty and filled by an update, because viser keeps both the creation and the last
    update for browsers that join later.
    """

    def __init__(self, link: Adapter, name: str) -> None:
        self._link = link
        self._name = name
        self._handle = self.create(link.server.scene, name)
        self._props: tuple[Props, ...] = ()

    @abstractmethod
    def create(self, scene: SceneApi, name: str) -> SceneNodeHandle:
        """Create the empty node."""

    @abstractmethod
    def props(self, node: NodeT) -> tuple[Props, ...]:
        """Disjoint sets of viser's properties; a set is sent when one of its values changes."""

    def draw(self, node: NodeT) -> None:
        """Send the sets of properties that changed."""
        sets = self.props(node)
        for index, props in enumerate(sets):
            if index >= len(self._props) or not _is_same(props, self._props[index]):
                self._link.update(self._name, props)
        self._props = sets

    def remove(self) -> None:
        """Remove the node from the scene."""
        self._handle.remove()


def rgb_array(colors: U8 | Rgb, count: int) -> U8:
    """Colours for viser: uint8 (count, 3), or (3,) for all items.

    Without items it is a single colour, since viser's shader does not support an empty array.
    """
    array = np.ascontiguousarray(colors, dtype=np.uint8)
    return array if count else np.zeros(3, dtype=np.uint8)


def marked(size: float, opacity: float, more: int = 0) -> float:
    """Return a size whose last bits are an opacity in steps of 1/255, and a multiple of 256.

    viser's lines and points are opaque. Their sizes reach the page as doubles, which the modules
    lines.js and points.js make use of.
    """
    mark = round(255 * (1.0 - opacity)) + more
    return float(np.float32(size)) * (1.0 + mark * 2.0**-OPACITY_BIT)


def finite(*arrays: NDArray[np.floating[Any]], along: Sequence[Any] = ()) -> list[Any]:
    """`arrays` as float32 without the rows that are not finite in all of them.

    A single NaN in a line or mesh breaks three.js' bounding volumes and so the whole page.

    Args:
        arrays: of the same length.
        along: one value per row each, filtered likewise and returned after `arrays`; a value for
            all rows (a tuple or a number) stays as it is.
    """
    whole = [np.ascontiguousarray(array, dtype=np.float32) for array in arrays]
    if all(np.isfinite(array).all() for array in whole):  # nearly always, and sooner known
        return [*whole, *along]
    rows = np.ones(len(whole[0]), dtype=bool)
    for array in whole:
        rows &= finite_rows(array)
    return [array[rows] for array in whole] + [
        each[rows] if isinstance(each, np.ndarray) and len(each) == len(rows) else each
        for each in along
    ]


def finite_rows(array: NDArray[np.floating[Any]]) -> NDArray[np.bool_]:
    """Return the mask of finite rows of an array."""
    is_finite = np.isfinite(array)
    if is_finite.all():  # nearly always, and ten times as fast as row by row
        return np.ones(len(array), np.bool_)
    return np.asarray(is_finite.all(axis=tuple(range(1, array.ndim))))


def _is_same(a: Props, b: Props) -> bool:
    return all(same(a[name], b[name]) for name in a)
