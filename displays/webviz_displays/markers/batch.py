"""Markers that are drawn together, as arrays."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec
import numpy as np
from numpy.typing import ArrayLike, NDArray

from webviz.data.messages.markers import Content, MarkerSequence
from webviz.data.rotations import normalized, w_first

F64 = NDArray[np.float64]
F32 = NDArray[np.float32]
U8 = NDArray[np.uint8]
Rows = NDArray[np.intp]

OPAQUE = 0.9998
"""Alphas from this value on are drawn opaque, as in RViz."""


class MarkerBatch(msgspec.Struct, frozen=True, eq=False):
    """Markers to draw, in the coordinates of one group.

    Args:
        types: int32 (N,), those of visualization_msgs/Marker.
        positions: float64 (N, 3), metres.
        wxyzs: float64 (N, 4), unit quaternions with w first.
        scales: float64 (N, 3).
        colors: float32 (N, 4), RGBA; 0 to 1, other values are clamped when drawn.
        own_materials: bool (N,), whether meshes keep the materials of their file.
        contents: the fields whose size varies.
        counts: (N,), the points of each.
        ids: (N,), what a marker is selected by.
    """

    types: NDArray[np.int32]
    positions: F64
    wxyzs: F64
    scales: F64
    colors: F32
    own_materials: NDArray[np.bool_]
    contents: Sequence[Content]
    counts: Rows
    ids: NDArray[np.int64]

    def __len__(self) -> int:
        return len(self.types)

    def only(self, rows: Rows) -> MarkerBatch:
        """Return some of the markers."""
        return MarkerBatch(
            self.types[rows],
            self.positions[rows],
            self.wxyzs[rows],
            self.scales[rows],
            self.colors[rows],
            self.own_materials[rows],
            [self.contents[row] for row in rows.tolist()],
            self.counts[rows],
            self.ids[rows],
        )


def batch_of(markers: MarkerSequence) -> MarkerBatch:
    """Markers at the poses of their messages; an orientation of all zeros is none."""
    return MarkerBatch(
        markers.types,
        markers.positions,
        normalized(w_first(markers.orientations))[0],
        markers.scales,
        markers.colors,
        markers.own_materials,
        markers.contents,
        np.array([len(content.points) for content in markers.contents], np.intp),
        np.arange(len(markers)),
    )


def opacities(alphas: ArrayLike) -> F64:
    """Alphas as opacities 0 to 1, in steps of 1/255."""
    values = np.asarray(alphas, np.float64)
    clamped = np.where(values >= OPAQUE, 1.0, np.clip(values, 0.0, 1.0))
    return np.asarray(np.ceil(clamped * 255.0 - 1e-3) / 255.0)


def rgb(colors: NDArray[np.floating]) -> U8:
    """Return the red, green and blue of colours (N, 3 or 4), uint8 (N, 3)."""
    return np.rint(np.clip(colors[..., :3], 0.0, 1.0) * 255.0).astype(np.uint8)
