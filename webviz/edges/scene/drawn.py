"""What every primitive has in common: one key of a group, drawn by one or more viser nodes."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, Generic, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray
from viser import SceneApi, SceneNodeHandle

from webviz.api.nodes import U8, Rgb, same
from webviz.edges.scene.adapter import Adapter

Props = dict[str, Any]
NodeT = TypeVar("NodeT")
NodeT_contra = TypeVar("NodeT_contra", contravariant=True)


class Drawn(Protocol[NodeT_contra]):
    """A node as the browsers have it."""

    def draw(self, node: NodeT_contra) -> None:
        """Sends what differs from what was drawn before."""
        ...

    def remove(self) -> None:
        """Takes it off the scene."""
        ...


class SingleNode(ABC, Generic[NodeT]):
    """A primitive that is one viser node.

    The node is created as small as possible and filled by an update, because viser keeps both the
    creation and the last update for browsers that join later.
    """

    def __init__(self, link: Adapter, name: str) -> None:
        self._link = link
        self._name = name
        self._handle = self.create(link.server.scene, name)
        self._sent: tuple[Props, ...] = ()

    @abstractmethod
    def create(self, scene: SceneApi, name: str) -> SceneNodeHandle:
        """Makes the placeholder."""

    @abstractmethod
    def props(self, node: NodeT) -> tuple[Props, ...]:
        """The node in viser's terms: disjoint sets of properties, each sent when it changed."""

    def draw(self, node: NodeT) -> None:
        """Sends the sets of properties that differ from those sent before."""
        sets = self.props(node)
        for index, props in enumerate(sets):
            if index >= len(self._sent) or not _is_same(props, self._sent[index]):
                self._link.update(self._name, props)
        self._sent = sets

    def remove(self) -> None:
        """Takes the node off the scene."""
        self._handle.remove()


def rgb_array(colors: U8 | Rgb, count: int) -> U8:
    """Colours as viser wants them: one for each of `count` items, or uint8 (3,) for all.

    An empty array of colours is no colour at all, which viser's shader cannot take.
    """
    array = np.ascontiguousarray(colors, dtype=np.uint8)
    return array if count else np.zeros(3, dtype=np.uint8)


def finite_rows(*arrays: NDArray[np.floating[Any]]) -> NDArray[np.bool_] | None:
    """Which rows are finite in all `arrays`, or None if every one is.

    A single NaN in a line or mesh breaks three.js' bounding volumes and so the whole page.
    """
    rows = np.ones(len(arrays[0]), dtype=bool)
    for array in arrays:
        rows &= np.isfinite(array).all(axis=tuple(range(1, array.ndim)))
    return None if rows.all() else rows


def _is_same(a: Props, b: Props) -> bool:
    return all(same(a[name], b[name]) for name in a)
