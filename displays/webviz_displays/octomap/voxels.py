"""Visibility and position of the voxels of an octree."""

from __future__ import annotations

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz_displays.octomap.octree import I64, LEVELS, Mask, Octree

F64 = NDArray[np.float64]

_X = sum(1 << (3 * bit) for bit in range(LEVELS))
"""The bits of x in a Morton code; those of y and z are one and two places higher."""


class Voxels(msgspec.Struct, frozen=True, eq=False):
    """Boxes of an octree.

    Args:
        nodes: (N,), of the tree.
        centers: (N, 3), metres.
        sizes: (N,), edges in metres.
    """

    nodes: NDArray[np.intp]
    centers: F64
    sizes: F64

    def only(self, chosen: Mask | NDArray[np.intp]) -> Voxels:
        """Return some of them."""
        return Voxels(self.nodes[chosen], self.centers[chosen], self.sizes[chosen])


def voxels_of(tree: Octree, depth: int) -> Voxels:
    """Return the leaves of a tree that is cut off below a depth, along the Morton curve."""
    is_end = tree.is_leaf & (tree.depths <= depth) | (tree.depths == depth)
    nodes = np.flatnonzero(is_end)
    nodes = nodes[np.argsort(tree.codes[nodes])]
    sizes = tree.resolution * np.exp2(LEVELS - tree.depths[nodes].astype(float))
    corners = np.stack([_coordinate(tree.codes[nodes], axis) for axis in range(3)], axis=1)
    centers = (corners - 2 ** (LEVELS - 1)) * tree.resolution + sizes[:, None] / 2
    return Voxels(nodes, centers, sizes)


def places_of(tree: Octree, voxels: Voxels) -> I64:
    """Numbers (N,) that voxels of the same place and size have in every tree."""
    return tree.codes[voxels.nodes] * 32 + tree.depths[voxels.nodes]


def is_exposed(tree: Octree, voxels: Voxels) -> Mask:
    """Return the mask of voxels (N,) with a side that others do not cover completely.

    A side counts as covered if the whole space of the size of the voxel beside it is.

    Args:
        tree: that they are of.
        voxels: none inside another, along the Morton curve.
    """
    starts = tree.codes[voxels.nodes]
    volumes = np.int64(1) << (3 * (LEVELS - tree.depths[voxels.nodes].astype(np.int64)))
    before = np.cumsum(volumes) - volumes

    def filled(places: I64) -> I64:
        """Return the volume of all voxels before each place of the curve."""
        index = np.searchsorted(starts, places, side="right") - 1
        inside = np.minimum(places - starts[index], volumes[index])
        return np.where(index < 0, 0, before[index] + inside)

    exposed = np.zeros(len(starts), np.bool_)
    for axis in range(3):
        bits = np.int64(_X << axis)
        own, others, step = starts & bits, starts & ~bits, volumes << axis
        above, below = ((own | ~bits) + step) & bits, (own - step) & bits
        exposed |= (above < own) | (below > own)  # at the border of the tree the code runs over
        for place in (above | others, below | others):
            exposed |= filled(place + volumes) - filled(place) < volumes
    return exposed


def _coordinate(codes: I64, axis: int) -> I64:
    """Return a coordinate (N,) of Morton codes, in smallest voxels from the corner of the tree."""
    coordinates = np.zeros_like(codes)
    for bit in range(LEVELS):
        coordinates |= (codes >> (2 * bit + axis)) & (1 << bit)
    return coordinates
