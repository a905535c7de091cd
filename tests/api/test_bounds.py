"""Extents of what is drawn."""

from __future__ import annotations

import math

import numpy as np
import pytest
import trimesh

from webviz.api.bounds import MOST_NODES, Box, bounds, box_around, union
from webviz.api.nodes import (
    Arrows,
    Axes,
    Glb,
    Image,
    Instances,
    Labels,
    Lines,
    Mesh,
    Node,
    Points,
    Pose,
)
from webviz.data import gltf

Corners = tuple[tuple[float, float, float], tuple[float, float, float]]

SEGMENT = np.array([[(0, 0, 0), (1, 2, 3)]], np.float32)
ORIGIN = np.zeros((1, 3), np.float32)
UNTURNED = np.array([(1, 0, 0, 0)], np.float32)


def box_of(node: Node) -> Corners:
    box = bounds(node)
    assert box is not None
    low, high = ([round(part, 5) for part in corner.tolist()] for corner in (box.low, box.high))
    return (low[0], low[1], low[2]), (high[0], high[1], high[2])


@pytest.mark.parametrize(
    ("node", "low", "high"),
    [
        (Points(SEGMENT[0], (0, 0, 0), 0.2), (-0.1, -0.1, -0.1), (1.1, 2.1, 3.1)),
        (Lines(SEGMENT, (0, 0, 0), 4.0, "px"), (0, 0, 0), (1, 2, 3)),
        (Lines(SEGMENT, (0, 0, 0), 1.0, "m"), (-0.5, -0.5, -0.5), (1.5, 2.5, 3.5)),
        (Arrows(SEGMENT, (0, 0, 0), 0.1, 0.5, 0.2), (-0.5, -0.5, -0.5), (1.5, 2.5, 3.5)),
        (Axes(ORIGIN, UNTURNED, 2.0, 0.1), (-2, -2, -2), (2, 2, 2)),
        (Labels(ORIGIN, ("a",), 0.5), (-0.5, -0.5, -0.5), (0.5, 0.5, 0.5)),
        (Mesh(SEGMENT[0], np.zeros((0, 3), np.uint32), (0, 0, 0)), (0, 0, 0), (1, 2, 3)),
        (Instances(ORIGIN, SEGMENT[0][1:], (0, 0, 0)), (-0.5, -1, -1.5), (0.5, 1, 1.5)),
        (Image(np.zeros((2, 2, 4), np.uint8), 3.0, 4.0), (0, 0, 0), (3, 4, 0)),
    ],
)
def test_the_box_of_each_kind_of_node(
    node: Node, low: tuple[float, ...], high: tuple[float, ...]
) -> None:
    assert box_of(node) == (low, high)


def test_turned_solids_are_within_their_box() -> None:
    turned = np.array([(0.8, 0.6, 0, 0)], np.float32)
    solid = Instances(ORIGIN, np.array([(3, 4, 0)], np.float32), (0, 0, 0), wxyzs=turned)
    assert box_of(solid) == ((-2.5, -2.5, -2.5), (2.5, 2.5, 2.5))


def test_a_binary_gltf_is_read_with_the_places_of_its_parts() -> None:
    scene = trimesh.Scene()
    turn = trimesh.transformations.rotation_matrix(math.pi / 2, (0, 0, 1), (0, 0, 0))
    turn[:3, 3] = (10, 0, 0)
    scene.add_geometry(trimesh.creation.box((2, 4, 6)), transform=turn)
    data = scene.export(file_type="glb")
    assert isinstance(data, bytes)
    assert box_of(Glb(data)) == ((8, -1, -3), (12, 1, 3))


def test_parts_of_a_gltf_are_scaled_then_turned_then_moved_and_hold_others() -> None:
    turn = math.sqrt(0.5)
    document = {
        "scenes": [{"nodes": [0]}],
        "nodes": [
            {"translation": [10, 0, 0], "rotation": [0, 0, turn, turn], "children": [1, 2]},
            {"mesh": 0},
            {"mesh": 0, "scale": [4, 1, 1]},
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"min": [0, 0, 0], "max": [1, 2, 3]}],
    }
    assert box_of(Glb(gltf.pack(document))) == ((8, 0, 0), (10, 4, 3))
    assert bounds(Glb(gltf.pack({"scenes": [{"nodes": []}]}))) is None


def test_points_of_a_large_cloud_are_looked_at_from_the_first_on_spread_evenly() -> None:
    xyz = np.zeros((10_000, 3), np.float32)
    xyz[:, 0] = np.arange(10_000)
    cloud = Points(xyz, (0, 0, 0), 0.2)
    quick, exact = bounds(cloud, most=300), bounds(cloud, most=10_000)
    assert quick is not None
    assert exact is not None
    assert (quick.low[0], quick.high[0]) == (0.0, 294 * 34)  # every 34th
    assert (exact.low[0], exact.high[0]) == pytest.approx((-0.1, 9999.1))


def test_empty_and_non_finite_points_have_no_box() -> None:
    assert bounds(Points(np.zeros((0, 3), np.float32), (0, 0, 0), 1.0)) is None
    points = np.array([(math.nan, 0, 0), (math.inf, 0, 0)], np.float32)
    assert bounds(Points(points, (0, 0, 0), 1.0)) is None
    assert union([]) is None


def test_a_moved_box_is_around_all_that_was_in_it() -> None:
    box = Box(np.zeros(3), np.array((2.0, 0.0, 0.0)))
    half = math.pi / 8
    box_in_world = box.moved(Pose((1.0, 0.0, 0.0), (math.cos(half), 0.0, 0.0, math.sin(half))))
    np.testing.assert_allclose(box_in_world.low, (1, 0, 0), atol=1e-12)
    np.testing.assert_allclose(box_in_world.high, (1 + 2**0.5, 2**0.5, 0), atol=1e-12)


def test_a_union_holds_all() -> None:
    boxes = [Box(np.full(3, low), np.full(3, low + 1.0)) for low in (0.0, -3.0, 2.0)]
    box = union(boxes)
    assert box is not None
    assert (box.low.tolist(), box.high.tolist()) == ([-3] * 3, [3] * 3)


def test_the_box_of_many_nodes_is_approximate_where_that_is_enough() -> None:
    point, turned = Points(ORIGIN, (0, 0, 0), 0.2), Pose(wxyz=(0.0, 0.0, 0.0, 1.0))
    placed = [(point, Pose((float(x), 0.0, 0.0)), turned) for x in range(10_000)]
    exact, quick = box_around(placed), box_around(placed, 1)
    assert exact is not None
    assert quick is not None
    assert exact.low == pytest.approx([-9999.1, -0.1, -0.1])
    assert exact.high == pytest.approx([0.1, 0.1, 0.1])
    assert -9999.1 < quick.low[0] < -9900.0
    few = box_around(placed[:MOST_NODES], 1)
    assert few is not None
    assert few.low[0] == pytest.approx(1 - MOST_NODES - 0.1)
    assert box_around([]) is None
