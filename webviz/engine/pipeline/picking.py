"""Items of displays behind what a browser picked in its picture."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields, replace
from typing import Any, TypeVar

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz.api.context import Group, Placement
from webviz.api.frames import Frames, compose
from webviz.api.nodes import Arrows, Axes, Instances, Labels, Lines, Mesh, Models, Points, Pose
from webviz.api.picking import Hit, count_of
from webviz.api.sample import Sample
from webviz.data.rotations import matrices
from webviz.data.transforms.geometry import REACH_M
from webviz.engine.commands import Pick
from webviz.engine.pipeline.baking import Position

TOLERANCE = 1e-6
"""Tolerance of coordinates that went to a browser and back, metres or a share of them."""
ARROW_TOLERANCE = 1e-4
"""Arrow tolerance of positions that a browser computed along an arrow."""

Items = Points | Lines | Arrows | Axes | Labels | Instances | Models
"""Nodes whose items are selected one by one."""

N = TypeVar("N", bound=Items)


class SceneSnapshot(msgspec.Struct, frozen=True, eq=False):
    """Picture drawn by one call of a hook.

    Args:
        groups: by key, as they were sent.
        samples: that it was drawn from.
        fixed_frame: that it was drawn in.
    """

    groups: Mapping[str, Group]
    samples: Sequence[Sample]
    fixed_frame: str


class PickedItem(msgspec.Struct, frozen=True, eq=False):
    """Something that was selected, and where it is.

    Args:
        hit: for the display.
        pose: of the node in its frame.
        placement: of its group.
        fixed_frame: that it was drawn in.
    """

    hit: Hit
    pose: Pose
    placement: Placement
    fixed_frame: str

    def position(self, frames: Frames) -> tuple[str, Position] | None:
        """Return a frame, and where it is in that frame.

        The fixed one unless that changed meanwhile.
        """
        frame, pose = self.fixed_frame, self.pose
        if (moving := self.placement.frame) is not None:
            is_latest = self.placement.when == "latest"
            outer = frames.latest(moving) if is_latest else frames.now(moving)
            if outer is None:
                return None
            frame, pose = frames.fixed_frame, compose(outer, pose)
        x, y, z = (matrices(pose.wxyz) @ self.hit.point + pose.position).tolist()
        return frame, (x, y, z)


def found_in(
    snapshot: SceneSnapshot, group_key: str, key: str, picks: Sequence[Pick]
) -> dict[int, PickedItem]:
    """Return the picked items of a node, by id, if this was on the screen.

    Of things that the node does not have, or has elsewhere, there is nothing: the picture was
    another one, or a program made them up.
    """
    group = snapshot.groups.get(group_key)
    node = group.nodes.get(key) if group else None
    picks = [pick for pick in picks if all(abs(c) <= REACH_M for c in pick[2])]
    if group is None or node is None or not picks:
        return {}
    finder = _finder(snapshot, group, key)
    if isinstance(node, Mesh) and node.ids is not None and len(node.faces):
        if len(node.ids) != len(node.faces):
            raise ValueError(f"a mesh has {len(node.faces)} faces, but {len(node.ids)} ids")
        return {
            pick[0]: finder(node.ids[_face_at(node, pick[2])].item(), pick[2]) for pick in picks
        }
    if not isinstance(node, Items):
        return {pick[0]: finder(None, pick[2]) for pick in picks}
    rows = drawn_rows(node)
    count = count_of(node) if rows is None else len(rows)
    picks = [pick for pick in picks if pick[1] is not None and 0 <= pick[1] < count]
    if not picks:
        return {}
    numbers = np.array([pick[1] for pick in picks])
    picked_rows = numbers if rows is None else rows[numbers]
    items = _only(node, picked_rows)
    same = _is_at(items, np.array([pick[2] for pick in picks]))  # pyright: ignore[reportArgumentType]
    if isinstance(items, Points) and not isinstance(items.colors, tuple):
        same &= [
            pick[3] == tuple(rgb) for pick, rgb in zip(picks, items.colors.tolist(), strict=True)
        ]
    points = _positions(items).astype(np.float64).tolist()
    ids = _ids(node, picked_rows)
    return {picks[i][0]: finder(ids[i], points[i]) for i in np.flatnonzero(same)}


def every_item(
    snapshot: SceneSnapshot, group_key: str, key: str, limit: int
) -> Sequence[PickedItem]:
    """All that can be picked of a node, by the numbers that browsers give its items.

    There is nothing of a node with more items than the limit, and of what depends on the point that
    is clicked, such as the cells of an image.
    """
    group = snapshot.groups[group_key]
    node, finder = group.nodes[key], _finder(snapshot, group, key)
    if isinstance(node, Mesh) and node.ids is None:
        return [finder(None, (0.0, 0.0, 0.0))]
    if not isinstance(node, Items) or count_of(node) > limit:
        return []
    rows = drawn_rows(node)
    rows = np.arange(count_of(node)) if rows is None else rows
    points = _positions(_only(node, rows)).astype(np.float64).tolist()
    return [finder(*each) for each in zip(_ids(node, rows), points, strict=True)]


def _finder(
    snapshot: SceneSnapshot, group: Group, key: str
) -> Callable[[Any, Position], PickedItem]:
    """Return what finds an item of a node, by its id and a point on it."""
    node, placement = group.nodes[key], group.placement
    pose = compose(placement.offset, group.poses.get(key, Pose()))
    frame = placement.frame or (snapshot.samples[-1].frame if snapshot.samples else "")
    return lambda id, point: PickedItem(
        Hit(key, node, id, point, frame, snapshot.samples), pose, placement, snapshot.fixed_frame
    )


def _ids(node: Items, rows: NDArray[np.intp]) -> list[Any]:
    if node.ids is None:
        return rows.tolist()
    if len(node.ids) != count_of(node):
        raise ValueError(f"a node has {count_of(node)} items, but {len(node.ids)} ids")
    return node.ids[rows].tolist()


def drawn_rows(node: Items) -> NDArray[np.intp] | None:
    """Return the rows that browsers have, None for all; those that are not finite are not sent."""
    if isinstance(node, Points):
        return None
    arrays = [getattr(node, name, None) for name in ("segments", "positions", "scales", "wxyzs")]
    tables = [array.reshape(len(array), -1) for array in arrays if array is not None]
    if all(math.isfinite(array.sum(dtype=np.float64)) for array in tables):
        return None
    return np.flatnonzero(np.all([np.isfinite(array).all(axis=1) for array in tables], axis=0))


def _only(node: N, rows: NDArray[np.intp]) -> N:
    """Return some of the items."""
    count = count_of(node)
    values = {f.name: getattr(node, f.name) for f in fields(node)}
    arrays = {name: v for name, v in values.items() if isinstance(v, np.ndarray)}
    chosen = {name: v[rows] for name, v in arrays.items() if len(v) == count and name != "ids"}
    return replace(node, ids=None, **chosen)


def _face_at(node: Mesh, point: Position) -> int:
    """Return the face that a point is on."""
    corners = node.vertices[node.faces].astype(np.float64)
    a = corners[:, 0]
    ab, ac, ap = corners[:, 1] - a, corners[:, 2] - a, point - a
    (bb, bc, cc), (pb, pc) = (
        [np.einsum("ij,ij->i", *pair) for pair in pairs]
        for pairs in (((ab, ab), (ab, ac), (ac, ac)), ((ap, ab), (ap, ac)))
    )
    area = np.maximum(bb * cc - bc * bc, np.finfo(np.float64).tiny)
    v, w = (cc * pb - bc * pc) / area, (bb * pc - bc * pb) / area
    # Barycentric coordinates, moved to the nearest that are inside or almost.
    weights = np.clip(np.column_stack((1.0 - v - w, v, w)), 0.0, 1.0)
    weights /= weights.sum(axis=1, keepdims=True)
    nearest = np.einsum("ij,ijk->ik", weights, corners)
    return int(np.argmin(((nearest - point) ** 2).sum(axis=1)))


def _positions(node: Items) -> NDArray[np.float32]:
    """Return where each item is; a line, in its middle; an arrow, at its tail."""
    if isinstance(node, Points):
        return node.xyz
    if isinstance(node, Lines):
        return node.segments.mean(axis=1)
    return node.segments[:, 0] if isinstance(node, Arrows) else node.positions


def _is_at(node: Items, positions: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return whether each item is where a browser has it."""
    if isinstance(node, Arrows):
        tails, tips = node.segments[:, 0].astype(np.float64), node.segments[:, 1]
        ways = tips - tails
        squares = np.maximum((ways**2).sum(axis=1), 1e-18)
        along = np.clip(((positions - tails) * ways).sum(axis=1) / squares, 0.0, 1.0)
        there, tolerance = tails + along[:, None] * ways, ARROW_TOLERANCE
    else:
        there = node.segments[:, 0] if isinstance(node, Lines) else _positions(node)
        tolerance = TOLERANCE
    is_close = np.isclose(there, positions, rtol=tolerance, atol=tolerance)
    return np.asarray(is_close.all(axis=1))
