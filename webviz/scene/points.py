"""Point clouds."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from viser import SceneApi, SceneNodeHandle

from webviz.api.nodes import F32, POINTS_PER_BLOCK, U8, Points, Rgb, same
from webviz.scene.adapter import Adapter
from webviz.scene.names import BLOCK_PREFIX, PART_PREFIX
from webviz.scene.visual import Props, SingleNode, marked, rgb_array
from webviz.server.sending.outbox import CLOUD

# Beyond the far plane of every camera.
_OUT_OF_SIGHT = np.full((2, 3), -1e9, dtype=np.float32)

PLANE = "plane"
"""Property of a point cloud that only our page knows, as `CLOUD`."""
PART = POINTS_PER_BLOCK
"""Points per viser node: half a megabyte with colours, so that on a slow network other messages can
be sent in between."""


class PointsVisual:
    """Points as viser point clouds, several for a large cloud.

    The first part is the parent of the others. Browsers show the parts of one cloud at once, unless
    they may thin it, which does not change; the first part they never thin.
    """

    def __init__(self, link: Adapter, name: str) -> None:
        self._link = link
        self._name = name
        self._parts = [_Part(link, name)]
        self._version = 0
        self._node: Points | None = None

    def draw(self, node: Points) -> None:
        """Send the parts that changed."""
        prefix = BLOCK_PREFIX if node.thins else PART_PREFIX
        while len(self._parts) * PART < len(node.xyz):
            self._parts.append(_Part(self._link, f"{self._name}/{prefix}{len(self._parts)}"))
        # Parts beyond are kept, empty, unless there are many: each is a message per cloud.
        needed = max(math.ceil(len(node.xyz) / PART), 1)
        while len(self._parts) > 2 * needed:
            self._parts.pop().remove()
            self._link.count_removals(1)
        if len(self._parts) == 1:
            self._node = None
            self._parts[0].draw(node)
            return
        self._version += not self._has(node.xyz, node.colors)
        self._node = node
        cloud = None if node.thins else (self._name, self._version, len(self._parts))
        for index, part in enumerate(self._parts):
            rows = slice(index * PART, (index + 1) * PART)
            colors = node.colors if isinstance(node.colors, tuple) else node.colors[rows]
            part.cloud = cloud
            part.draw(replace(node, xyz=node.xyz[rows], colors=colors))

    def remove(self) -> None:
        """Remove the points from the scene."""
        self._link.count_removals(len(self._parts) - 1)
        self._parts[0].remove()

    def _has(self, xyz: F32, colors: U8 | Rgb) -> bool:
        node = self._node
        return node is not None and same(node.xyz, xyz) and same(node.colors, colors)


class _Part(SingleNode[Points]):
    """Points as a viser point cloud, flat and in float32: exact colours, precision 1e-7."""

    cloud: tuple[str, int, int] | None = None
    """Name, version and number of parts of the cloud that it is part of, None if it is whole."""

    def create(self, scene: SceneApi, name: str) -> SceneNodeHandle:
        """Return a cloud without points."""
        return _add(scene, name, np.zeros((0, 3), np.float32), np.zeros(3, np.uint8))

    def props(self, node: Points) -> tuple[Props, ...]:
        """Positions with colours, then the look."""
        places: Props = {
            "points": np.ascontiguousarray(node.xyz, dtype=np.float32),
            "colors": rgb_array(node.colors, len(node.xyz)),
            CLOUD: self.cloud,
            PLANE: node.plane,
        }
        return (
            places,
            # viser draws a point twice as wide as its size (measured).
            {"point_size": marked(node.size / 2.0, node.opacity), "point_shape": node.shape},
        )


def keep_shaders(scene: SceneApi, root: str) -> None:
    """Add clouds out of sight, which keep the point shaders alive.

    viser creates a new material for each update with colours, and three.js compiles its shader
    again (0.4 s without a GPU) unless another node uses it. There is one shader for a colour per
    point and one for a single colour, each for opaque and for translucent points.
    """
    for look, opacity in (("", 1.0), ("translucent ", 0.5)):
        kind = f"{root}/%shader of {look}"
        each, one = np.zeros((2, 3), np.uint8), np.zeros(3, np.uint8)
        _add(scene, f"{kind}coloured points", _OUT_OF_SIGHT, each, marked(0.01, opacity))
        _add(scene, f"{kind}plain points", _OUT_OF_SIGHT, one, marked(0.01, opacity))


def _add(
    scene: SceneApi, name: str, points: np.ndarray, colors: np.ndarray, size: float = 0.01
) -> SceneNodeHandle:
    return scene.add_point_cloud(
        name, points, colors, precision="float32", point_shading="flat", point_size=size
    )
