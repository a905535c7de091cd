"""The items of lists: points with a colour each, of many markers at once."""

from __future__ import annotations

import msgspec
import numpy as np

from webviz.data.rotations import matrices
from webviz_displays.markers.batch import F32, F64, MarkerBatch, Rows

_MANY = 4
"""Markers above which they are moved together."""


class Items(msgspec.Struct, frozen=True, eq=False):
    """The points of several markers, one after another.

    Args:
        xyz: float64 (M, 3), in the coordinates of the group, metres.
        colors: float32 (M, 4), RGBA, that of the marker unless each of its points has one; (1, 4)
            if all are equal.
        rows: (M,), the marker in the batch that each belongs to.
    """

    xyz: F64
    colors: F32
    rows: Rows


def items_of(batch: MarkerBatch, rows: Rows, points: list[F64] | None = None) -> Items:
    """Return the points of the markers in some rows, or other `points` in their place."""
    contents = [batch.contents[row] for row in rows.tolist()]
    points = [content.points for content in contents] if points is None else points
    counts = np.array([len(each) for each in points], np.intp)
    owners = np.repeat(rows, counts)
    if not len(owners):
        return Items(np.zeros((0, 3)), np.zeros((0, 4), np.float32), owners)
    xyz = points[0] if len(points) == 1 else np.concatenate(points)
    ends = np.cumsum(counts)
    own = [
        (slice(end - count, end), content.colors)
        for content, count, end in zip(contents, counts.tolist(), ends.tolist(), strict=True)
        if count and len(content.colors) == count
    ]
    if not own and (batch.colors[rows] == batch.colors[rows[0]]).all():
        colors = batch.colors[rows[:1]]
    else:
        colors = batch.colors[owners]
        for part, each in own:
            colors[part] = each
    return Items(_placed(batch, rows, counts, xyz, owners), colors, owners)


def _placed(batch: MarkerBatch, rows: Rows, counts: Rows, xyz: F64, owners: Rows) -> F64:
    """Points moved from the coordinates of their markers to those of the group."""
    is_turned = (batch.wxyzs[rows, 1:] != 0.0).any(axis=1)
    if len(rows) > _MANY:
        if is_turned.any():
            rotations = np.repeat(matrices(batch.wxyzs[rows]), counts, axis=0)
            xyz = np.einsum("nij,nj->ni", rotations, xyz)
        return xyz + batch.positions[owners]
    moved = np.empty_like(xyz)
    ends = np.cumsum(counts)
    for row, turned, start, end in zip(rows, is_turned, ends - counts, ends, strict=True):
        part = xyz[start:end]
        if turned:
            part = np.einsum("ij,nj->ni", matrices(batch.wxyzs[row]), part)
        np.add(part, batch.positions[row], out=moved[start:end])
    return moved
