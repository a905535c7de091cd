"""The displays of nvblox: meshes, and layers of voxels."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Annotated, Any, ClassVar

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz import (
    Context,
    Details,
    Display,
    Hit,
    Input,
    Instances,
    Lookback,
    Mesh,
    Node,
    Prop,
    Remedy,
    Sample,
    Topic,
)
from webviz.api.nodes import F32, U8
from webviz.data.words import counted
from webviz_displays.shared.geometry import FARTHEST

Key = tuple[int, int, int]
"""Index of a block along x, y and z; its corner is at the index times the size of blocks."""

GREY = 160
"""Brightness of what the message gives no colour."""

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
    by_region: dict[Key, list[MapBlock]] = {}
    for (x, y, z), block in blocks:
        by_region.setdefault((x // edge, y // edge, z // edge), []).append(block)
    return by_region


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


EDGE = 4
"""Blocks along the edge of a node."""


class _State(msgspec.Struct):
    """State of what is drawn: blocks and their node, by region."""

    regions: dict[Key, tuple[Sequence[MapBlock], Node]] = msgspec.field(default_factory=dict)


class NvbloxDisplay(Display):
    """Base of displays of maps of blocks; messages bring those that have changed."""

    noun: ClassVar[str] = ""
    """One of the things that are drawn."""
    most: ClassVar[int] = 0
    """Maximum number of items drawn at once."""

    cut_ceiling: Annotated[bool, Prop(help="Hide blocks above Ceiling Height.")] = False
    ceiling_height: Annotated[
        float,
        Prop(ge=-1e6, le=1e6, unit="m", when=("cut_ceiling", True), help="In the map's frame."),
    ] = 1.5

    def new_state(self) -> _State:
        """Nothing drawn."""
        return _State()

    def lookback(self, name: str) -> Lookback:
        """All messages since one that clears the map."""
        return Lookback(starts_over=lambda message, _: bool(message.clear))

    def fold(self, name: str, sample: Sample, state: Layer | None) -> Layer:
        """Take the blocks of a message."""
        return (state or Layer()).merged(sample.message)

    def draw(self, sample: Sample, ctx: Context) -> None:
        """Draw the blocks, in the frame and at the stamp of the newest message."""
        layer: Layer = sample.message
        state: _State = ctx.state
        for what, metres in (("block_size_m", layer.block_m), ("voxel_size_m", layer.voxel_m)):
            if not 0 <= metres < FARTHEST:
                ctx.error("Blocks", f"{what} is {metres:g}. Fix the publisher.")
                return
        top = self.ceiling_height if self.cut_ceiling else math.inf
        by_region: dict[Key, tuple[Sequence[MapBlock], Node]] = {}
        count = left_out = 0
        for key, blocks in regions(layer.below(top), EDGE).items():
            size = sum(self.size(block) for block in blocks)
            if count + size > self.most:
                left_out += size
                continue
            count += size
            before = state.regions.get(key)
            is_known = before is not None and list(map(id, before[0])) == list(map(id, blocks))
            by_region[key] = before if before and is_known else (blocks, self.node(blocks, layer))
            ctx.add("region {} {} {}".format(*key), by_region[key][1])
        state.regions = by_region
        self._report(layer, count, left_out, ctx)

    def size(self, block: MapBlock) -> int:
        """Return the number of items drawn for a block."""
        raise NotImplementedError

    def node(self, blocks: Sequence[MapBlock], layer: Layer) -> Node:
        """Return the node that draws blocks."""
        raise NotImplementedError

    def _report(self, layer: Layer, count: int, left_out: int, ctx: Context) -> None:
        amounts = f"{counted(count, self.noun)} in {counted(len(layer.blocks), 'block')}"
        if layer.faults:
            (x, y, z), why = next(iter(layer.faults.items()))
            more = len(layer.faults) - 1
            rest = f", and {more} more" if more else ""
            ctx.warn("Blocks", f"Block {x} {y} {z} is left out{rest}: {why}. Fix the publisher.")
        elif layer.dropped:
            dropped = counted(layer.dropped, "block")
            ctx.warn("Blocks", f"{dropped} left out: the map is too large. Send it with clear set.")
        elif left_out:
            ctx.warn("Blocks", f"Showing {count} of {counted(count + left_out, self.noun)}.")
        elif not layer.blocks:
            ctx.warn("Blocks", "The map is empty.")
        elif not count:
            top = layer.block_m * (1 + max(z for _, _, z in layer.blocks))
            remedy = Remedy("ceiling_height", top, f"Raise it to {top:g} m")
            ctx.warn("Blocks", "All blocks are above Ceiling Height. Raise it.", remedy)
        else:
            ctx.ok("Blocks", f"{amounts} of {layer.block_m:g} m.")


class NvbloxMesh(NvbloxDisplay):
    """The surfaces that nvblox reconstructs, in the colours of its cameras."""

    rviz = "nvblox_rviz_plugin/NvbloxMesh"
    noun: ClassVar[str] = "triangle"
    most: ClassVar[int] = 1_000_000

    topic: Annotated[Topic, Input("nvblox_msgs/msg/Mesh"), Prop(help="Topic of the meshes.")] = (
        Topic("/nvblox_node/mesh")
    )

    def size(self, block: MapBlock) -> int:
        """Its triangles."""
        return len(block.faces)

    def node(self, blocks: Sequence[MapBlock], layer: Layer) -> Mesh:
        """One mesh."""
        starts = np.cumsum([0, *(len(block.points) for block in blocks)], dtype=np.uint32)
        faces = [block.faces + start for block, start in zip(blocks, starts, strict=False)]
        colors = np.concatenate([block.colors for block in blocks])
        opaque = np.full((len(colors), 1), 255, np.uint8)
        return Mesh(
            np.concatenate([block.points for block in blocks]),
            np.concatenate(faces).astype(np.uint32),
            (255, 255, 255),
            colors=np.hstack((colors, opaque)),
        )


class NvbloxVoxelBlockLayer(NvbloxDisplay):
    """The voxels of a layer of nvblox, such as obstacles, people or colours."""

    rviz = "nvblox_rviz_plugin/NvbloxVoxelBlockLayer"
    noun: ClassVar[str] = "voxel"
    most: ClassVar[int] = 200_000

    topic: Annotated[
        Topic, Input("nvblox_msgs/msg/VoxelBlockLayer"), Prop(help="Topic of the voxels.")
    ] = Topic("/nvblox_node/color_layer")

    def size(self, block: MapBlock) -> int:
        """Its voxels."""
        return len(block.points)

    def node(self, blocks: Sequence[MapBlock], layer: Layer) -> Instances:
        """Return a box for each voxel."""
        centers = np.concatenate([block.points for block in blocks])
        return Instances(
            centers,
            np.full(centers.shape, layer.voxel_m, np.float32),
            np.concatenate([block.colors for block in blocks]),
            is_data=True,
        )

    def inspect(self, hit: Hit, ctx: Context) -> Details | None:
        """Return the length of the edges of a voxel."""
        layer: Layer = hit.sample.message
        return Details("Voxel", {"Edge": f"{layer.voxel_m:g} m"})
