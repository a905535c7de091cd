"""Visible voxels of an octree and their colours."""

from __future__ import annotations

from typing import Literal

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz import ColorScale
from webviz_displays.octomap.octree import Octree
from webviz_displays.octomap.voxels import Voxels, is_exposed, voxels_of
from webviz_displays.shared.colors import RAINBOW, ramp
from webviz_displays.shared.geometry import is_drawable

U8 = NDArray[np.uint8]
Rendering = Literal["Occupied Voxels", "Free Voxels", "All Voxels"]

MAX_VOXELS = 200_000
"""Boxes drawn at once; each takes 43 bytes to send."""

_HUES = 0.96
"""RViz's colours end at hue 288° at the lowest voxel, those of `RAINBOW` at 300°."""
_STOPS = 7


class VoxelChoice(msgspec.Struct, frozen=True):
    """Selection of the voxels of a tree.

    Args:
        rendering: whether occupied ones, free ones or both.
        depth: below which the tree is cut off.
        low, high: of their centres, metres.
    """

    rendering: Rendering
    depth: int
    low: float
    high: float


class VisibleVoxels(msgspec.Struct, frozen=True, eq=False):
    """The voxels that can be seen from outside.

    Args:
        voxels: at most `MAX_VOXELS`.
        total: how many there are with those inside.
        depth: at which the tree had to be cut off.
    """

    voxels: Voxels
    total: int
    depth: int


def seen_of(tree: Octree, choice: VoxelChoice) -> VisibleVoxels:
    """Return the voxels to draw: no deeper than allowed, and coarser until they are few enough."""
    for depth in range(choice.depth, -1, -1):
        voxels = voxels_of(tree, depth)
        heights, log_odds = voxels.centers[:, 2], tree.log_odds[voxels.nodes]
        is_wanted = (heights >= choice.low) & (heights <= choice.high) & ~np.isnan(log_odds)
        if choice.rendering != "All Voxels":
            is_wanted &= (log_odds >= 0) == (choice.rendering == "Occupied Voxels")
        chosen = voxels.only(is_wanted & is_drawable(voxels.centers))
        exposed = chosen.only(is_exposed(tree, chosen))
        if len(exposed.nodes) <= MAX_VOXELS:
            return VisibleVoxels(exposed, len(chosen.nodes), depth)
    raise AssertionError("a tree has one root")


def by_height(voxels: Voxels, low: float, high: float) -> tuple[U8, ColorScale]:
    """Colours (N, 3) from magenta at `low` to red at `high`, in metres, and their scale."""
    stops = ramp(_HUES * np.linspace(1.0, 0.0, _STOPS), 0.0, 1.0)
    scale = ColorScale("z (m)", low, high, tuple((r, g, b) for r, g, b in stops.tolist()))
    span = high - low
    shares = (voxels.centers[:, 2] - low) / span if span > 0.0 else np.zeros(len(voxels.nodes))
    return ramp(_HUES * (1.0 - shares), 0.0, 1.0, RAINBOW), scale


def by_probability(log_odds: NDArray[np.float32]) -> tuple[U8, ColorScale]:
    """Colours (N, 3) from red, certainly free, to green, certainly occupied, and their scale."""
    stops = ((255, 0, 0), (0, 255, 0))
    return ramp(probabilities(log_odds), 0.0, 1.0, stops), ColorScale("occupancy", 0.0, 1.0, stops)


def probabilities(log_odds: NDArray[np.float32]) -> NDArray[np.float64]:
    """Return the probabilities of being occupied, (N,)."""
    with np.errstate(over="ignore"):
        return 1.0 / (1.0 + np.exp(-log_odds.astype(np.float64)))
