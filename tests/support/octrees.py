"""Writes octrees as octomap_msgs/Octomap, node by node."""

from __future__ import annotations

import struct
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

OCTOMAP = "octomap_msgs/msg/Octomap"
Key = tuple[int, int, int]


@dataclass
class OctreeNode:
    """A node of a tree.

    Args:
        log_odds: of being occupied.
        color: of trees that have one.
        children: by number.
    """

    log_odds: float = 0.0
    color: Key = (255, 255, 255)
    children: dict[int, OctreeNode] = field(default_factory=dict)

    def place(self, key: Key, depth: int = 16, **values: Any) -> None:
        """Put a voxel at a depth into the tree of this root.

        Args:
            key: in voxels of that depth from the centre of the tree.
            depth: 16 are the smallest voxels.
            values: its fields.
        """
        node, (x, y, z) = self, (each + (1 << (depth - 1)) for each in key)
        for level in range(depth - 1, -1, -1):
            number = (x >> level & 1) | (y >> level & 1) << 1 | (z >> level & 1) << 2
            node = node.children.setdefault(number, OctreeNode())
        for name, value in values.items():
            setattr(node, name, value)

    def settle(self) -> float:
        """Give inner nodes the largest value of their children."""
        if self.children:
            self.log_odds = max(child.settle() for child in self.children.values())
        return self.log_odds


def octree(voxels: Iterable[Key], log_odds: float = 3.5, depth: int = 16) -> OctreeNode:
    """A tree of voxels of one depth."""
    root = OctreeNode()
    for key in voxels:
        root.place(key, depth, log_odds=log_odds)
    return root


def binary(root: OctreeNode, resolution: float = 0.1, kind: str = "OcTree") -> dict[str, Any]:
    """The tree as a binary message."""
    root.settle()
    return {"id": kind, "binary": True, "resolution": resolution, "data": _binary(root)}


def full(root: OctreeNode, resolution: float = 0.1, kind: str = "OcTree") -> dict[str, Any]:
    """The tree as a full message; the kind decides whether it has colours."""
    root.settle()
    data = _full(root, kind.startswith("Color"))
    return {"id": kind, "binary": False, "resolution": resolution, "data": signed(data)}


def signed(data: bytes) -> list[int]:
    """Bytes as int8."""
    return list(struct.unpack(f"{len(data)}b", data))


def _binary(node: OctreeNode) -> list[int]:
    """Bytes as int8."""
    bits = 0
    for number, child in node.children.items():
        kind = 3 if child.children else 2 if child.log_odds >= 0 else 1
        bits |= kind << (2 * number)
    data = signed(struct.pack("<H", bits))
    for _, child in sorted(node.children.items()):
        if child.children:
            data += _binary(child)
    return data


def _full(node: OctreeNode, has_color: bool) -> bytes:
    data = struct.pack("<f", node.log_odds)
    if has_color:
        data += bytes(node.color)
    data += bytes([sum(1 << number for number in node.children)])
    return data + b"".join(_full(child, has_color) for _, child in sorted(node.children.items()))
