"""The NvbloxMesh display."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, ClassVar

import numpy as np

from webviz import Input, Mesh, Prop, Topic
from webviz_displays.nvblox.base import NvbloxDisplay
from webviz_displays.nvblox.layer import Layer, MapBlock


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
