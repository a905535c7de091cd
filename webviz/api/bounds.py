"""Bounding boxes of nodes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from webviz.api.nodes import (
    Arrows,
    Axes,
    Glb,
    Image,
    Instances,
    Labels,
    Lines,
    Mesh,
    Models,
    Node,
    Pane,
    Points,
    Pose,
    Shape,
    Solid,
)
from webviz.data.gltf import unpack
from webviz.data.rotations import matrices

F64 = NDArray[np.float64]

MOST_NODES = 300
"""Nodes that are looked at for an approximate box: 10 ms of them."""
_DEEPEST = 64
_CORNERS = np.array(np.meshgrid([0, 1], [0, 1], [0, 1])).reshape(3, 8).T


@dataclass(frozen=True, eq=False)
class Box:
    """An axis-aligned box.

    Args:
        low, high: float64 (3,), corners in metres.
    """

    low: F64
    high: F64

    def moved(self, pose: Pose) -> Box:
        """Return the axis-aligned box around this one at a pose."""
        corners = np.where(_CORNERS, self.high, self.low) @ matrices(pose.wxyz).T + pose.position
        return Box(corners.min(axis=0), corners.max(axis=0))


def bounds(node: Node, most: int = 0) -> Box | None:
    """Return the box around a node in its own coordinates; None if nothing of it is visible.

    Args:
        node: the node.
        most: number of points that are looked at of a cloud, spread evenly; 0 for all.
    """
    if most and isinstance(node, Points) and len(node.xyz) > most:
        return _around((node.xyz[:: -(-len(node.xyz) // most)], 0.0))
    return _around(_EXTENTS[type(node)](node))


def box_around(placed: Sequence[tuple[Node, Pose, Pose]], most: int = 0) -> Box | None:
    """Return the box around nodes; None if nothing of them is visible.

    Args:
        placed: each node with its pose in a group, and the pose of that group.
        most: see `bounds`; if it is given, `MOST_NODES` are looked at, spread evenly.
    """
    step = -(-len(placed) // MOST_NODES) if most else 1
    return union(
        box.moved(pose).moved(outer)
        for node, pose, outer in placed[:: step or 1]
        if (box := bounds(node, most)) is not None
    )


def union(boxes: Iterable[Box]) -> Box | None:
    """Return the box around several boxes; None without any."""
    boxes = list(boxes)
    if not boxes:
        return None
    low = np.min([box.low for box in boxes], axis=0)
    return Box(low, np.max([box.high for box in boxes], axis=0))


Extents = tuple[Any, Any]
"""Points (N, 3), and their extent in all directions: a number, (N, 1) or (N, 3)."""


def _around(extents: Extents) -> Box | None:
    points, reach = np.asarray(extents[0], dtype=np.float64).reshape(-1, 3), extents[1]
    low, high = points - reach, points + reach
    finite = np.isfinite(low).all(axis=1) & np.isfinite(high).all(axis=1)
    if not finite.any():
        return None
    return Box(low[finite].min(axis=0), high[finite].max(axis=0))


def _of_instances(node: Instances) -> Extents:
    half = np.asarray(node.scales, dtype=np.float64) * _half_size(node.shape)
    if node.wxyzs is not None:  # within its bounding sphere, however it is rotated
        half = np.linalg.norm(half, axis=-1, keepdims=True)
    return node.positions, half


def _half_size(shape: Solid | Shape) -> Any:
    """Return the extent of a shape from its origin along each axis, at scale 1."""
    if isinstance(shape, str):
        return 0.5
    return np.abs(shape.vertices.astype(np.float64)).max(axis=0, initial=0.0)


def _of_models(node: Models) -> Extents:
    points, _ = _of_model(node.data)
    half = np.abs(points).max(axis=0, initial=0.0) * np.abs(node.scales.astype(np.float64))
    return node.positions, np.linalg.norm(half, axis=1, keepdims=True)


def _of_model(data: bytes) -> Extents:
    document, _ = unpack(data)
    scene = document.get("scenes", [{}])[document.get("scene", 0)]
    corners = list(_corners(document, scene.get("nodes", []), np.eye(4), 0))
    return np.concatenate(corners) if corners else np.zeros((0, 3)), 0.0


def _corners(document: dict[str, Any], nodes: list[int], outer: F64, depth: int) -> Iterator[F64]:
    """Corners of the boxes of all meshes below nodes of a glTF, each float64 (8, 3)."""
    for index in nodes if depth < _DEEPEST else ():
        node = document["nodes"][index]
        matrix = outer @ _matrix(node)
        meshes = [document["meshes"][node["mesh"]]] if "mesh" in node else []
        for primitive in (each for mesh in meshes for each in mesh["primitives"]):
            accessor = document["accessors"][primitive["attributes"]["POSITION"]]
            box = np.where(_CORNERS, accessor["max"], accessor["min"])
            yield box @ matrix[:3, :3].T + matrix[:3, 3]
        yield from _corners(document, node.get("children", []), matrix, depth + 1)


def _matrix(node: dict[str, Any]) -> F64:
    """Return the matrix of a glTF node relative to its parent, float64 (4, 4)."""
    if "matrix" in node:
        return np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
    x, y, z, w = node.get("rotation", (0.0, 0.0, 0.0, 1.0))
    matrix = np.eye(4)
    matrix[:3, :3] = matrices((w, x, y, z)) * node.get("scale", (1.0, 1.0, 1.0))
    matrix[:3, 3] = node.get("translation", (0.0, 0.0, 0.0))
    return matrix


_EXTENTS: dict[type, Callable[[Any], Extents]] = {
    Points: lambda node: (node.xyz, node.size / 2.0),
    Lines: lambda node: (node.segments, node.width / 2.0 if node.unit == "m" else 0.0),
    Arrows: lambda node: (node.segments, max(node.shaft_radius, node.head_radius)),
    Axes: lambda node: (node.positions, node.length),
    Labels: lambda node: (node.positions, node.height),
    Mesh: lambda node: (node.vertices, 0.0),
    Instances: _of_instances,
    Models: _of_models,
    Glb: lambda node: _of_model(node.data),
    Pane: lambda node: ([], 0.0),
    Image: lambda node: ([(0.0, 0.0, 0.0), (node.width, node.height, 0.0)], 0.0),
}
