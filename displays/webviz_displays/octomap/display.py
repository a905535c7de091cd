"""The displays of octrees."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz import Context, Details, Display, Hit, Input, Pose, Prop, Remedy, Sample, Topic, compose
from webviz_displays.octomap.octree import (
    LEVELS,
    SLOW_BYTES,
    Octree,
    OctreeFault,
    keep_memory,
    memory_for,
    read_octree,
)
from webviz_displays.octomap.visible_voxels import (
    MAX_VOXELS,
    Rendering,
    VisibleVoxels,
    VoxelChoice,
    by_height,
    by_probability,
    probabilities,
    seen_of,
)
from webviz_displays.octomap.voxels import places_of, voxels_of
from webviz_displays.shared.colors import Alpha
from webviz_displays.shared.geometry import FARTHEST, origin_near
from webviz_displays.shared.properties import opaque

OCTOMAP = "octomap_msgs/msg/Octomap"

_NOUNS: dict[Rendering, str] = {
    "Occupied Voxels": "occupied voxels",
    "Free Voxels": "free voxels",
    "All Voxels": "voxels",
}


class _TreeReading(msgspec.Struct, frozen=True, eq=False):
    """Octree read last, so that a change of colour does not read it again.

    Args:
        message: that the others are of.
        choice: that `voxels` is of.
        tree: None if it cannot be read.
        span: lowest and highest z of its leaves, metres.
        voxels: the voxels to draw, None without a tree.
        fault: why there is none.
    """

    message: Any = None
    choice: VoxelChoice | None = None
    tree: Octree | None = None
    span: tuple[float, float] = (0.0, 0.0)
    voxels: VisibleVoxels | None = None
    fault: str = ""


class _State(msgspec.Struct):
    """Kept between messages, of which a large one may be drawn in a thread beside a small one.

    Args:
        reading: the octree read last.
        drawing: the tree and what is drawn of it.
    """

    reading: _TreeReading = msgspec.field(default_factory=_TreeReading)
    drawing: tuple[Octree, VisibleVoxels] | None = None


class OctreeDisplay(Display):
    """Base of RViz's displays of octrees, which differ in the type of tree that they accept."""

    is_threaded = True
    slow_bytes = SLOW_BYTES

    topic: Annotated[Topic, Input(OCTOMAP), Prop(help="Topic of the octrees.")] = Topic(
        "/octomap_full"
    )
    voxel_rendering: Annotated[
        Rendering, Prop(help="Draw voxels that are occupied, known to be free, or both.")
    ] = "Occupied Voxels"
    voxel_coloring: Annotated[
        Literal["Cell Color", "Z-Axis", "Cell Probability"],
        Prop(
            help="Cell Color: that in the tree. Z-Axis: magenta (low) to red (high). "
            "Cell Probability: red (free) to green (occupied)."
        ),
    ] = "Z-Axis"
    voxel_alpha: Annotated[Alpha, Prop(help="Opacity; 0 is invisible.")] = 1.0
    max_octree_depth: Annotated[
        int,
        Prop(
            ge=0,
            le=LEVELS,
            rviz="Max. Octree Depth",
            help="Each level less doubles the size of the smallest voxels; 0 is all levels.",
        ),
    ] = LEVELS
    max_height: Annotated[
        float,
        Prop(
            ge=-FARTHEST,
            le=FARTHEST,
            unit="m",
            rviz="Max. Height Display",
            help="Hide voxels with a centre above this z of the tree's frame.",
        ),
    ] = FARTHEST
    min_height: Annotated[
        float,
        Prop(
            ge=-FARTHEST,
            le=FARTHEST,
            unit="m",
            rviz="Min. Height Display",
            help="Hide voxels with a centre below this z of the tree's frame.",
        ),
    ] = -FARTHEST

    def new_state(self) -> _State:
        """Nothing read."""
        return _State()

    def draw(self, sample: Sample, ctx: Context) -> None:
        """Draw the visible voxels as boxes, in the frame and at the stamp of the header."""
        state: _State = ctx.state
        levels = self.max_octree_depth or LEVELS
        choice = VoxelChoice(self.voxel_rendering, levels, self.min_height, self.max_height)
        reading = state.reading
        if reading.message is not sample.message or reading.fault or reading.choice != choice:
            reading = state.reading = _read(reading, sample.message, choice)
        tree, visible = reading.tree, reading.voxels
        if tree is None or visible is None:
            ctx.error("Octree", reading.fault)
            return
        state.drawing = tree, visible
        self._report(tree, visible, levels, ctx)
        voxels = visible.voxels
        if not len(voxels.nodes) or self.voxel_alpha == 0:
            return
        origin = origin_near(voxels.centers)
        ctx.follow(None, offset=compose(sample.pose, Pose(origin))).instances(
            "voxels",
            "box",
            voxels.centers - origin,
            np.repeat(voxels.sizes[:, None], 3, axis=1),
            self._colors(tree, visible, reading.span, ctx),
            opacity=self.voxel_alpha,
            is_data=True,
            ids=places_of(tree, voxels),
        )

    def inspect(self, hit: Hit, ctx: Context) -> Details | None:
        """Return the voxel at the place of the one that was selected, with its newest values."""
        state: _State = ctx.state
        if state.drawing is None:
            return None
        tree, visible = state.drawing
        places = np.flatnonzero(places_of(tree, visible.voxels) == hit.id)
        if not len(places):
            return None
        voxels = visible.voxels.only(places)
        node = int(voxels.nodes[0])
        log_odds = tree.log_odds[[node]]
        values: dict[str, object] = {
            "Occupancy": f"{probabilities(log_odds)[0]:.1%}",
            "Log-odds": log_odds[0],
            f"Centre in {hit.sample.frame}": voxels.centers[0],
            "Size": f"{voxels.sizes[0]:g} m",
            "Depth": int(tree.depths[node]),
        }
        if tree.colors is not None:
            values["Color"] = "r {}, g {}, b {}".format(*tree.colors[node].tolist())
        return Details("Occupied voxel" if log_odds[0] >= 0 else "Free voxel", values)

    def _colors(
        self, tree: Octree, visible: VisibleVoxels, span: tuple[float, float], ctx: Context
    ) -> NDArray[np.uint8]:
        voxels = visible.voxels
        if self.voxel_coloring == "Cell Color" and tree.colors is not None:
            return tree.colors[voxels.nodes]
        if self.voxel_coloring == "Cell Probability":
            colors, ctx.color_scale = by_probability(tree.log_odds[voxels.nodes])
            return colors
        colors, ctx.color_scale = by_height(voxels, *span)
        return colors

    def _other_voxels(self, tree: Octree) -> Remedy:
        """Return the change that shows voxels: those of the other kind, or of more heights."""
        heights = voxels_of(tree, LEVELS).centers[:, 2]
        is_low, is_high = heights < self.min_height, heights > self.max_height
        if not (is_low | is_high).all():
            return Remedy("voxel_rendering", "All Voxels", "Show all voxels")
        if is_high.any():
            return Remedy("max_height", FARTHEST, "Show all above")
        return Remedy("min_height", -FARTHEST, "Show all below")

    def _report(self, tree: Octree, visible: VisibleVoxels, levels: int, ctx: Context) -> None:
        """Say what the tree is, what of it is drawn, and what is not as chosen."""
        nodes = len(tree.codes)
        ctx.ok("Octree", f"{tree.kind} of {nodes} nodes, smallest voxels {tree.resolution:g} m.")
        if self.voxel_coloring == "Cell Color" and tree.colors is None:
            ctx.warn(
                "Colors",
                "The tree has no colours, so voxels are coloured by height. Publish a full "
                "ColorOcTree or choose another Voxel Coloring.",
                Remedy("voxel_coloring", "Z-Axis", "Colour by height"),
            )
        count, noun = len(visible.voxels.nodes), _NOUNS[self.voxel_rendering]
        text = f"Showing {count} {noun}"
        if enclosed := visible.total - count:
            text += f"; they enclose {enclosed} more"
        if not count:
            ctx.warn(
                "Voxels",
                f"The tree has no {noun} within the heights. Choose another Voxel Rendering or "
                "other heights.",
                self._other_voxels(tree),
            )
        elif self.voxel_alpha == 0:
            ctx.warn(
                "Voxels",
                "Invisible: alpha is 0. Increase it to show the voxels.",
                opaque("voxel_alpha"),
            )
        elif visible.depth < levels:
            ctx.warn(
                "Voxels",
                f"{text}. More than {MAX_VOXELS} would be seen below depth {visible.depth}, so "
                "smaller ones are merged. Limit the heights to see them.",
                Remedy("max_octree_depth", visible.depth, f"Stop at depth {visible.depth}"),
            )
        else:
            ctx.ok("Voxels", f"{text}.")


class OccupancyGrid(OctreeDisplay):
    """Voxels of an octree: occupied and free space, such as that of octomap_server."""

    rviz = "octomap_rviz_plugins/OccupancyGrid"


class ColorOccupancyGrid(OctreeDisplay):
    """Voxels of an octree with colours."""

    rviz = "octomap_rviz_plugins/ColorOccupancyGrid"


class OccupancyGridStamped(OctreeDisplay):
    """Voxels of an octree whose nodes have stamps."""

    rviz = "octomap_rviz_plugins/OccupancyGridStamped"


def _read(before: _TreeReading, message: Any, choice: VoxelChoice) -> _TreeReading:
    """Read a tree, unless it is known, and what is to be drawn of it."""
    tree, span = (before.tree, before.span) if before.message is message else (None, (0.0, 0.0))
    try:
        with memory_for(message):
            if tree is None:
                tree, span = _tree_of(message)
            return _TreeReading(message, choice, tree, span, seen_of(tree, choice))
    except OctreeFault as fault:
        return _TreeReading(message, choice, fault=str(fault))


def _tree_of(message: Any) -> tuple[Octree, tuple[float, float]]:
    """Return the tree of a message, and its lowest and highest z."""
    tree = read_octree(message)
    keep_memory(tree)
    leaves = voxels_of(tree, LEVELS)
    edges, heights = leaves.sizes / 2, leaves.centers[:, 2]
    return tree, (float((heights - edges).min()), float((heights + edges).max()))
