"""The blocks of a map, collected from its messages."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz.api.nodes import F32, U8
from webviz_displays.shared.geometry import FARTHEST

Key = tuple[int, int, int]
"""Index of a block along x, y and z; its corner is at the index times the size of blocks."""

GREY = 160
"""Of what the message gives no colour."""

MAX_POINTS = 3_000_000
"""Corners or voxels that are held; 48 MB."""


class MapBlock(msgspec.Struct, frozen=True, eq=False):
    """A part of the map.

    Args:
        points: (N, 3), corners or centres of voxels in metres in the frame of the map.
        colors: (N, 3).
        faces: (M, 3), corners of triangles; none in maps of voxels.
    """

    points: F32
    colors: U8
    faces: NDArray[np.uint32]


class Layer(msgspec.Struct, frozen=True, eq=False):
    """All blocks that are known.

    Args:
        block_m: edge of a block.
        voxel_m: edge of a voxel, 0 in a map of triangles.
        blocks: by index; never empty ones.
        points: of all blocks.
        faults: why blocks of the newest message are not taken, by index.
        dropped: blocks that are left out because there are too many points.
    """

    block_m: float = 0.0
    voxel_m: float = 0.0
    blocks: Mapping[Key, MapBlock] = msgspec.field(default_factory=dict)
    points: int = 0
    faults: Mapping[Key, str] = msgspec.field(default_factory=dict)
    dropped: int = 0

    def merged(self, message: Any) -> Layer:
        """Return the layer after a message: an nvblox_msgs/msg/Mesh or VoxelBlockLayer."""
        blocks = {} if message.clear else dict(self.blocks)
        points = 0 if message.clear else self.points
        dropped = 0 if message.clear else self.dropped
        faults: dict[Key, str] = {}
        for index, part in zip(message.block_indices.tolist(), message.blocks, strict=False):
            key: Key = tuple(index)
            if (before := blocks.pop(key, None)) is not None:
                points -= len(before.points)
            block = _block_of(part)
            if isinstance(block, str):
                faults[key] = block
            elif points + len(block.points) > MAX_POINTS:
                dropped += 1
            elif len(block.points):
                blocks[key] = block
                points += len(block.points)
        voxel_m = getattr(message, "voxel_size_m", 0.0)
        return Layer(message.block_size_m, voxel_m, blocks, points, faults, dropped)

    def below(self, height: float) -> Iterator[tuple[Key, MapBlock]]:
        """Return the blocks whose lower side is not above a height in m, as in RViz2's plug-in."""
        return ((k, block) for k, block in self.blocks.items() if k[2] * self.block_m <= height)


def regions(blocks: Iterable[tuple[Key, MapBlock]], edge: int) -> dict[Key, list[MapBlock]]:
    """Blocks by cubes of that many along each edge, since each node costs browsers a draw call."""
    found: dict[Key, list[MapBlock]] = {}
    for (x, y, z), block in blocks:
        found.setdefault((x // edge, y // edge, z // edge), []).append(block)
    return found


def _block_of(part: Any) -> MapBlock | str:
    """Return a block of a message, or why it cannot be drawn."""
    is_mesh = hasattr(part, "triangles")
    points = part.vertices if is_mesh else part.centers
    triangles = part.triangles if is_mesh else np.empty(0, np.int32)
    if len(part.colors) not in (0, len(points)):
        return f"it has {len(points)} points, but {len(part.colors)} colours"
    if not (np.abs(points) < FARTHEST).all():  # so that NaN is refused
        return "a point is not finite or farther than 1e9 m"
    if len(triangles) % 3:
        return f"its {len(triangles)} corners of triangles are not a multiple of 3"
    if len(triangles) and not (triangles.min() >= 0 and triangles.max() < len(points)):
        return f"a triangle has a corner besides its {len(points)} vertices"
    colors = np.full((len(points), 3), GREY, np.uint8)
    if len(part.colors):
        shares = np.nan_to_num(np.clip(part.colors[:, :3], 0.0, 1.0))
        colors = np.rint(255 * shares).astype(np.uint8)
    faces = np.ascontiguousarray(triangles.reshape(-1, 3), np.uint32)
    return MapBlock(np.ascontiguousarray(points, np.float32), colors, faces)
