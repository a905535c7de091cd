"""The items of lists: points with a colour each, of many markers at once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from webviz.data.rotations import matrices
from webviz_displays.markers.batch import F32, F64, Batch, Rows

_MANY = 4
"""Markers above which they are rotated together."""


@dataclass(frozen=True, eq=False)
class Items:
    """The points of several markers, one after another.

    Args:
        xyz: float64 (M, 3), in the coordinates of the group, metres.
        colors: float32 (M, 4), RGBA; that of the marker unless each of its points has one.
        rows: (M,), the marker in the batch that each belongs to.
    """

    xyz: F64
    colors: F32
    rows: Rows

    def only(self, chosen: NDArray[Any] | slice) -> Items:
        """Some of the items."""
        return Items(self.xyz[chosen], self.colors[chosen], self.rows[chosen])


def items_of(batch: Batch, rows: Rows, points: list[F64] | None = None) -> Items:
    """The points of the markers in some rows, or other `points` in their place."""
    contents = [batch.contents[row] for row in rows.tolist()]
    points = [content.points for content in contents] if points is None else points
    counts = np.array([len(each) for each in points], np.intp)
    owners = np.repeat(rows, counts)
    if not len(owners):
        return Items(np.zeros((0, 3)), np.zeros((0, 4), np.float32), owners)
    xyz = points[0] if len(points) == 1 else np.concatenate(points)
    colors = batch.colors[owners]
    ends = np.cumsum(counts)
    for content, count, end in zip(contents, counts.tolist(), ends.tolist(), strict=True):
        if count and len(content.colors) == count:
            colors[end - count : end] = content.colors
    return Items(_placed(batch, rows, counts, xyz, owners), colors, owners)


def _placed(batch: Batch, rows: Rows, counts: Rows, xyz: F64, owners: Rows) -> F64:
    """Points moved from the coordinates of their markers to those of the group."""
    is_turned = (batch.wxyzs[rows, 1:] != 0.0).any(axis=1)
    moved = xyz + batch.positions[owners]
    if not is_turned.any():
        return moved
    rotations = matrices(batch.wxyzs[rows])
    if len(rows) > _MANY:
        turned = np.einsum("nij,nj->ni", np.repeat(rotations, counts, axis=0), xyz)
        return turned + batch.positions[owners]
    ends = np.cumsum(counts)
    for index in np.flatnonzero(is_turned).tolist():
        part = slice(ends[index] - counts[index], ends[index])
        moved[part] = np.einsum("ij,nj->ni", rotations[index], xyz[part])
        moved[part] += batch.positions[rows[index]]
    return moved
