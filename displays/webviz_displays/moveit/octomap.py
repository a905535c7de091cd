"""Drawing of the octomap of a scene."""

from __future__ import annotations

from typing import Any, Literal

import msgspec
import numpy as np

from webviz import Context, Details, Frames, Hit, Pose, Remedy, compose
from webviz.data.words import counted
from webviz_displays.moveit.frames import Links, Places
from webviz_displays.moveit.joints import pose_of
from webviz_displays.moveit.scene import KnownScene
from webviz_displays.octomap.octree import LEVELS, OctreeFault, memory_for, read_octree
from webviz_displays.octomap.visible_voxels import (
    VisibleVoxels,
    VoxelChoice,
    by_height,
    by_probability,
    seen_of,
)
from webviz_displays.shared.geometry import FARTHEST, origin_near

KEY = "octomap"
ALL_VOXELS = Remedy("scene_geometry.voxel_rendering", "All Voxels", "Show all voxels")
Rendering = Literal["Occupied Voxels", "Free Voxels", "All Voxels", "Disabled"]
Coloring = Literal["Z-Axis", "Cell Probability"]


class _Read(msgspec.Struct, frozen=True, eq=False):
    """Result of a worker.

    Args:
        voxels: what is drawn.
        log_odds: of its voxels.
        fault: why there is nothing, or "".
    """

    voxels: VisibleVoxels | None = None
    log_odds: Any = None
    fault: str = ""


class Octomap(msgspec.Struct):
    """The octomap that is drawn.

    Args:
        message: octomap_msgs/OctomapWithPose.
        number: of the message.
        reading: what is drawn of it.
    """

    message: Any = None
    number: int = 0
    reading: _Read | None = None

    def draw(
        self,
        scene: KnownScene,
        places: Places,
        links: Links,
        looks: tuple[Rendering, Coloring, float],
        frame: str,
        ctx: Context,
    ) -> None:
        """Draw it, once it is read.

        Args:
            scene: with the octomap.
            places: of the objects of the scene.
            links: poses in `frame`.
            looks: which voxels, in which colours, and their opacity.
            frame: of the scene.
            ctx: receives nodes and statuses.
        """
        rendering, coloring, alpha = looks
        message = scene.octomap
        if message is None or not len(message.octomap.data) or rendering == "Disabled":
            return
        if message is not self.message:
            self.message, self.number = message, self.number + 1
        pose = self._pose(scene, places, links, frame, ctx.frames)
        if pose is None:
            name = message.header.frame_id
            ctx.error(
                "Octomap", f"The frame '{name:.80}' is unknown. {ctx.frames.why_not(name[:80])}"
            )
            return
        choice = VoxelChoice(rendering, LEVELS, -FARTHEST, FARTHEST)
        reading = ctx.background((KEY, self.number, rendering), _read, message.octomap, choice)
        self.reading = reading or self.reading
        if reading is None:
            ctx.warn("Octomap", "Reading the octomap.")
        if self.reading is None or (visible := self.reading.voxels) is None:
            if self.reading is not None:
                ctx.error("Octomap", self.reading.fault)
            return
        voxels = visible.voxels
        if not len(voxels.nodes):
            text = f"It has no {rendering.lower()}. Choose another Voxel Rendering."
            ctx.warn("Octomap", text, None if rendering == "All Voxels" else ALL_VOXELS)
            return
        if reading is not None:
            ctx.ok("Octomap", f"Showing {counted(len(voxels.nodes), 'voxel')} of {visible.total}.")
        edges, heights = voxels.sizes / 2.0, voxels.centers[:, 2]
        if coloring == "Z-Axis":
            low, high = float((heights - edges).min()), float((heights + edges).max())
            colors, _ = by_height(voxels, low, high)
        else:
            colors, _ = by_probability(self.reading.log_odds)
        if alpha > 0.0:
            origin = origin_near(voxels.centers)
            ctx.follow(frame, offset=compose(pose, Pose(origin)), key=KEY).instances(
                KEY,
                "box",
                voxels.centers - origin,
                np.repeat(voxels.sizes[:, None], 3, axis=1),
                colors,
                opacity=alpha,
                is_data=True,
            )

    def inspect(self, hit: Hit) -> Details | None:
        """Return a voxel."""
        visible = self.reading and self.reading.voxels
        if (
            hit.key != KEY
            or visible is None
            or hit.id is None
            or hit.id >= len(visible.voxels.nodes)
        ):
            return None
        size = f"{visible.voxels.sizes[hit.id]:g} m"
        return Details("Voxel of the octomap", {"Size": size})

    def _pose(
        self, scene: KnownScene, places: Places, links: Links, frame: str, frames: Frames
    ) -> Pose | None:
        at, turn = self.message.origin.position, self.message.origin.orientation
        pose = pose_of((at.x, at.y, at.z), (turn.w, turn.x, turn.y, turn.z))
        name = (self.message.header.frame_id or self.message.octomap.header.frame_id).lstrip("/")
        base = places.base(name, scene, frame, links, frames)
        return compose(base, pose) if base and pose else None


def _read(message: Any, choice: VoxelChoice) -> _Read:
    """Return the visible voxels of a tree, in a worker."""
    try:
        with memory_for(message):
            tree = read_octree(message)
            visible = seen_of(tree, choice)
    except OctreeFault as fault:
        return _Read(fault=str(fault))
    return _Read(visible, tree.log_odds[visible.voxels.nodes])
