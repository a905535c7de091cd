"""The NvbloxVoxelBlockLayer display."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, ClassVar

import numpy as np

from webviz import Context, Details, Hit, Input, Instances, Prop, Topic
from webviz_displays.nvblox.base import NvbloxDisplay
from webviz_displays.nvblox.layer import Layer, MapBlock


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
        """Where a voxel is, and its edge."""
        layer: Layer = hit.sample.message
        return Details("Voxel", {"Edge": f"{layer.voxel_m:g} m"})
