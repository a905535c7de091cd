"""The displays of nvblox: meshes, and layers of voxels."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Annotated, ClassVar

import msgspec
import numpy as np

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
from webviz.data.words import counted
from webviz_displays.nvblox.layer import Key, Layer, MapBlock, regions
from webviz_displays.shared.geometry import FARTHEST

EDGE = 4
"""Blocks along the edge of a node."""


class _State(msgspec.Struct):
    """State of what is drawn: blocks and their node, by region."""

    drawn: dict[Key, tuple[Sequence[MapBlock], Node]] = msgspec.field(default_factory=dict)


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
        drawn: dict[Key, tuple[Sequence[MapBlock], Node]] = {}
        count = left_out = 0
        for key, blocks in regions(layer.below(top), EDGE).items():
            size = sum(self.size(block) for block in blocks)
            if count + size > self.most:
                left_out += size
                continue
            count += size
            before = state.drawn.get(key)
            is_known = before is not None and list(map(id, before[0])) == list(map(id, blocks))
            drawn[key] = before if before and is_known else (blocks, self.node(blocks, layer))
            ctx.add("region {} {} {}".format(*key), drawn[key][1])
        state.drawn = drawn
        self._report(layer, count, left_out, ctx)

    def size(self, block: MapBlock) -> int:
        """Return the number of items drawn for a block."""
        raise NotImplementedError

    def node(self, blocks: Sequence[MapBlock], layer: Layer) -> Node:
        """Return the node that draws blocks."""
        raise NotImplementedError

    def _report(self, layer: Layer, count: int, left_out: int, ctx: Context) -> None:
        shown = f"{counted(count, self.noun)} in {counted(len(layer.blocks), 'block')}"
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
            ctx.ok("Blocks", f"{shown} of {layer.block_m:g} m.")


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
