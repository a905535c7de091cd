"""Picks of browsers, found among what was drawn."""

from __future__ import annotations

import numpy as np
import pytest

from webviz.api.context import Group, Placement, When
from webviz.api.frames import Frames
from webviz.api.nodes import Arrows, Lines, Mesh, Node, Points
from webviz.data.transforms import TransformBuffer
from webviz.engine.commands import Pick
from webviz.engine.pipeline.picking import SceneSnapshot, found_in

Point = tuple[float, float, float]
NUMBER = 5
"""Number of a pick."""
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], np.float32)
FACES = np.array([[0, 1, 2], [0, 2, 3]], np.uint32)
"""A square of two triangles."""


def pick(node: Node, item: int | None, point: Point) -> tuple[int, Point] | None:
    """Return id and position of what a browser picked of a node that is drawn alone."""
    group = Group(Placement())
    group.add("node", node)
    picks: list[Pick] = [(NUMBER, item, point, None)]
    hits = found_in(SceneSnapshot({"": group}, (), "map"), "", "node", picks).get(NUMBER)
    return None if hits is None else (hits.hit.id, (*hits.hit.point,))


@pytest.mark.parametrize(
    ("point", "face"),
    [
        ((0.6, 0.2, 0.0), 0),
        ((0.2, 0.6, 0.0), 1),
        ((1.7, 0.5, 0.0), 0),  # beside all, nearest to this one
        ((0.4, 0.7, 3.0), 1),
    ],
)
def test_a_point_belongs_to_the_nearest_face(point: Point, face: int) -> None:
    mesh = Mesh(CORNERS, FACES, (1, 2, 3), ids=np.array([10, 11]))
    assert pick(mesh, None, point) == (10 + face, point)


@pytest.mark.parametrize("count", [1, 3])
def test_a_mesh_has_as_many_ids_as_faces(count: int) -> None:
    mesh = Mesh(CORNERS, FACES, (1, 2, 3), ids=np.arange(count))
    with pytest.raises(ValueError, match=f"a mesh has 2 faces, but {count} ids"):
        pick(mesh, None, (0.5, 0.5, 0.0))


def test_a_point_on_a_face_belongs_to_it() -> None:
    random = np.random.default_rng(0)
    vertices = random.uniform(-5.0, 5.0, (30, 3)).astype(np.float32)
    faces = np.arange(30, dtype=np.uint32).reshape(10, 3)
    mesh = Mesh(vertices, faces, (1, 2, 3), ids=np.arange(10))
    for number, corners in enumerate(vertices[faces].astype(np.float64)):
        for weights in random.dirichlet((1.0, 1.0, 1.0), 20):
            x, y, z = (weights @ corners).tolist()
            assert pick(mesh, None, (x, y, z)) == (number, (x, y, z))


@pytest.mark.parametrize(
    ("point", "is_there"),
    [((2.0, 0.0, 0.0), True), ((3.0, 0.0, 0.0), True), ((2.5, 0.0, 0.5), False)],
    ids=["tail", "shaft", "beside"],
)
def test_an_arrow_is_where_its_tail_is(point: Point, is_there: bool) -> None:
    segments = np.array([[[0, 0, 0], [0, 1, 0]], [[2, 0, 0], [4, 0, 0]]], np.float32)
    expected = (1, (2.0, 0.0, 0.0)) if is_there else None
    assert pick(Arrows(segments, (1, 2, 3), 0.1, 0.2, 0.3), 1, point) == expected


def test_a_line_is_where_its_middle_is() -> None:
    segments = np.array([[[0, 0, 0], [0, 1, 0]], [[2, 0, 0], [4, 0, 0]]], np.float32)
    lines = Lines(segments, (1, 2, 3), 1.0)
    assert pick(lines, 1, (2.0, 0.0, 0.0)) == (1, (3.0, 0.0, 0.0))
    assert pick(lines, 2, (2.0, 0.0, 0.0)) is None


@pytest.mark.parametrize(("when", "x"), [("latest", 3.0), ("now", 2.0)])
def test_a_hit_on_a_moving_frame_has_the_pose_of_its_drawing(when: When, x: float) -> None:
    buffer = TransformBuffer()
    for stamp_ns, at in ((1, 1.0), (2, 2.0)):
        buffer.set_transform("map", "cart", stamp_ns, (at, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
    points = Points(np.array([[1, 0, 0]], np.float32), (1, 2, 3), 0.1)
    group = Group(Placement("cart", when))
    group.add("node", points)
    picks: list[Pick] = [(NUMBER, 0, (1.0, 0.0, 0.0), None)]
    hits = found_in(SceneSnapshot({"": group}, (), "map"), "", "node", picks)[NUMBER]
    assert hits.position(Frames(buffer, "map", 1)) == ("map", (x, 0.0, 0.0))
