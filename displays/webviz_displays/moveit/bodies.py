"""Collision objects of MoveIt as plain data that can be drawn."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import msgspec
import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from webviz import Pose, Solid
from webviz.data.messages import PoseSequence
from webviz.data.rotations import multiply_many, normalized, w_first
from webviz.data.words import counted
from webviz_displays.moveit.joints import pose_of
from webviz_displays.shared.geometry import LONGEST, is_drawable, transformed
from webviz_displays.shared.rods import rods

F32 = NDArray[np.float32]
F64 = NDArray[np.float64]

BOX, SPHERE, CYLINDER, CONE, PRISM = range(1, 6)
"""Types of shape_msgs/SolidPrimitive."""
_COUNTS = {BOX: 3, SPHERE: 1, CYLINDER: 2, CONE: 2}
_KINDS: Mapping[int, Solid] = {BOX: "box", SPHERE: "sphere", CYLINDER: "cylinder", CONE: "cone"}

PLANE_SIZE = 10.0
"""Metres: a plane has no end, so a square of it is drawn."""
PLANE_THICKNESS = 0.002
MAX_FAULTS = 10
"""Sentences that are kept of an object."""
SLOW_BYTES = 100_000
"""Size in bytes from which on messages with objects are read in a thread: 600 objects in 40 ms."""
LONGEST_NAME = 80
"""Characters of a name in a sentence."""
NO_VERTICES = np.zeros((0, 3), np.float32)
NO_FACES = np.zeros((0, 3), np.uint32)


class Primitives(NamedTuple):
    """Boxes, spheres, cylinders or cones.

    Attributes:
        positions: float64 (N, 3), metres.
        wxyzs: float64 (N, 4), unit quaternions.
        scales: float64 (N, 3), extents, metres; cylinders and cones are along z.
    """

    positions: F64
    wxyzs: F64
    scales: F64


class Body(msgspec.Struct, frozen=True, eq=False):
    """A collision object.

    Args:
        id: its name.
        type: key of its type, "" if it has none.
        frame: that `pose` is given in, "" for that of the scene.
        pose: of the object.
        solids: by kind, in the coordinates of the object.
        vertices: float32 (V, 3), of all meshes, in the coordinates of the object.
        faces: uint32 (F, 3), of all meshes.
        subframes: poses by name, in the coordinates of the object.
        faults: what of it is left out and why, sentences.
        size: bytes that it takes, roughly.
    """

    id: str
    type: str
    frame: str
    pose: Pose
    solids: Mapping[Solid, Primitives]
    vertices: F32
    faces: NDArray[np.uint32]
    subframes: Mapping[str, Pose] = msgspec.field(default_factory=dict)
    faults: tuple[str, ...] = ()
    size: int = 0

    def joined(self, more: Body) -> Body:
        """Return the same with the shapes of another, in the coordinates of this one."""
        solids = dict(self.solids)
        for kind, some in more.solids.items():
            pairs = zip(solids[kind], some, strict=True) if kind in solids else ()
            solids[kind] = Primitives(*map(np.concatenate, pairs)) if kind in solids else some
        return replace(
            self,
            solids=solids,
            vertices=np.concatenate((self.vertices, more.vertices)),
            faces=np.concatenate((self.faces, more.faces + np.uint32(len(self.vertices)))),
            subframes={**self.subframes, **more.subframes},
            faults=(*self.faults, *more.faults)[:MAX_FAULTS],
            size=self.size + more.size,
        )

    @property
    def shapes(self) -> dict[str, int]:
        """Return the number of shapes of each kind."""
        counts: dict[str, int] = {kind: len(some.positions) for kind, some in self.solids.items()}
        return counts | ({"triangle": len(self.faces)} if len(self.faces) else {})


def named(name: str) -> str:
    """Return a name in quotes, shortened if it is long."""
    return f"'{name[: LONGEST_NAME - 3]}...'" if len(name) > LONGEST_NAME else f"'{name}'"


def body_of(message: Any) -> Body | None:
    """Return a moveit_msgs/CollisionObject, None if its pose is invalid."""
    at, turn = message.pose.position, message.pose.orientation
    pose = pose_of((at.x, at.y, at.z), (turn.w, turn.x, turn.y, turn.z))
    if pose is None:
        return None
    faults: list[str] = []
    parts = [*_primitives(message.primitives, message.primitive_poses, faults)]
    if len(message.planes) or len(message.plane_poses):
        parts += _planes(message.planes, message.plane_poses, faults)
    rows: dict[Solid, list[tuple[Any, ...]]] = {}
    for kind, row in parts:
        rows.setdefault(kind, []).append(row)
    solids: dict[Solid, Primitives] = {}
    for kind, some in rows.items():
        solids[kind] = Primitives(*_columns(some))
    vertices, faces = NO_VERTICES, NO_FACES
    if len(message.meshes) or len(message.mesh_poses):
        vertices, faces = _meshes(message.meshes, message.mesh_poses, faults)
    subframes = _subframes(message.subframe_names, message.subframe_poses)
    size = vertices.nbytes + faces.nbytes + 200 * len(parts) + 1000
    size += 4 * (len(message.id) + sum(200 + len(name) for name in subframes))
    about = f"Object {named(message.id)}: "
    return Body(
        message.id,
        message.type.key[:LONGEST_NAME],
        message.header.frame_id.lstrip("/"),
        pose,
        solids,
        vertices,
        faces,
        subframes,
        tuple(about + fault for fault in dict.fromkeys(faults))[:MAX_FAULTS],
        size,
    )


def _columns(rows: list[tuple[Any, ...]]) -> Iterator[F64]:
    return (np.array(column, float) for column in zip(*rows, strict=True))


def _primitives(
    primitives: Sequence[Any], poses: PoseSequence, faults: list[str]
) -> Iterator[tuple[Solid, tuple[Any, ...]]]:
    places, turns, ok = _places(poses, len(primitives), faults)
    for row, each in enumerate(primitives):
        kind = int(each.type)
        if kind not in _KINDS:
            what = "prisms" if kind == PRISM else f"primitives of type {kind}"
            faults.append(f"{what} are not supported.")
            continue
        sizes = each.dimensions[: _COUNTS[kind]].tolist()
        if len(sizes) < _COUNTS[kind] or not all(0.0 < size <= LONGEST for size in sizes):
            faults.append(f"a {_KINDS[kind]} has invalid dimensions.")
        elif ok[row]:
            yield _KINDS[kind], (places[row], turns[row], _extents(kind, sizes))


def _extents(kind: int, sizes: list[float]) -> tuple[float, ...]:
    """Return the extents of a primitive from its edges, its radius, or its height and radius."""
    if kind == BOX:
        return tuple(sizes)
    radius = sizes[-1]
    return 2 * radius, 2 * radius, 2 * radius if kind == SPHERE else sizes[0]


def _planes(
    planes: F64, poses: PoseSequence, faults: list[str]
) -> Iterator[tuple[Solid, tuple[Any, ...]]]:
    """Squares of planes ax + by + cz + d = 0, coefficients (N, 4), around the nearest point."""
    places, turns, ok = _places(poses, len(planes), faults)
    with np.errstate(all="ignore"):  # checked below
        lengths = np.linalg.norm(planes[:, :3], axis=1, keepdims=True)
        normals = planes[:, :3] / lengths
        nearest = -normals * planes[:, 3:] / lengths
    valid = is_drawable(nearest) & np.isfinite(normals).all(axis=1)
    if not valid.all():
        faults.append(f"{counted(int((~valid).sum()), 'plane')} without a valid normal.")
    rows = np.flatnonzero(valid & ok)
    squares = rods(nearest[rows], nearest[rows] + normals[rows], 1.0)
    for row, place, turn in zip(rows.tolist(), nearest[rows], squares.wxyzs, strict=True):
        pose = Pose(tuple(places[row]), tuple(turns[row]))
        where = transformed(pose, place[None])[0]
        turned = multiply_many(turns[row], turn)
        yield "box", (where, turned, (PLANE_SIZE, PLANE_SIZE, PLANE_THICKNESS))


def _meshes(
    meshes: Sequence[Any], poses: PoseSequence, faults: list[str]
) -> tuple[F32, NDArray[np.uint32]]:
    """All meshes as one."""
    places, turns, ok = _places(poses, len(meshes), faults)
    all_vertices, all_faces = [NO_VERTICES], [NO_FACES]
    first = 0
    for row, mesh in enumerate(meshes):
        vertices, faces = mesh.vertices, mesh.triangles
        good = is_drawable(vertices)
        inside = (faces < len(vertices)).all(axis=1)
        inside[inside] = good[faces[inside]].all(axis=1)
        if not inside.all():
            faults.append(f"{counted(int((~inside).sum()), 'triangle')} with an invalid vertex.")
        if not ok[row] or not inside.any():
            continue
        pose = Pose(tuple(places[row]), tuple(turns[row]))
        moved = transformed(pose, np.where(good[:, None], vertices, 0.0))
        all_vertices.append(moved.astype(np.float32))
        all_faces.append(faces[inside] + np.uint32(first))
        first += len(vertices)
    return np.concatenate(all_vertices), np.concatenate(all_faces)


def _places(poses: PoseSequence, count: int, faults: list[str]) -> tuple[Any, Any, Any]:
    """Positions (count, 3), quaternions (count, 4), and which are valid; the origin by default."""
    pose_count = min(len(poses), count)
    if len(poses) > count:
        faults.append("it has more poses than shapes.")
    positions, wxyzs = np.zeros((count, 3)), np.zeros((count, 4))
    wxyzs[:, 0] = 1.0
    ok = np.ones(count, bool)
    if not pose_count:
        return positions, wxyzs, ok
    raw = w_first(poses.orientations[:pose_count])
    turns, is_turn = normalized(raw)
    is_zero = ~raw.any(axis=1)
    ok[:pose_count] = (is_turn | is_zero) & is_drawable(poses.positions[:pose_count])
    positions[:pose_count] = np.where(ok[:pose_count, None], poses.positions[:pose_count], 0.0)
    wxyzs[:pose_count] = turns
    if not ok.all():
        faults.append(f"{counted(int((~ok).sum()), 'pose')} cannot be drawn.")
    return positions, wxyzs, ok


def _subframes(names: Sequence[str], poses: PoseSequence) -> dict[str, Pose]:
    by_name = {}
    for name, position, xyzw in zip(names, poses.positions, poses.orientations, strict=False):
        if (pose := pose_of(position.tolist(), np.roll(xyzw, 1).tolist())) is not None:
            by_name[name] = pose
    return by_name
