"""Markers as nodes: sizes, colours and alpha of each type."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from marker_fields import colors, named, points

from webviz import Instances, Labels, Lines, Mesh, Points
from webviz.data.messages import decode, encode
from webviz.data.messages.markers import Marker, MarkerSequence
from webviz.data.rotations import matrices
from webviz_displays.markers.batch import batch_of
from webviz_displays.markers.nodes import nodes_of

ARRAY = "visualization_msgs/msg/MarkerArray"
LEFT = {"z": np.sqrt(0.5), "w": np.sqrt(0.5)}
"""A quarter turn about z."""


def marker(
    type_: int, scale: Any = (1, 1, 1), rgba: Any = (1, 0, 0, 1), **more: Any
) -> dict[str, Any]:
    """A marker at (10, 0, 0), turned left."""
    return {
        "type": type_,
        "pose": {"position": {"x": 10.0}, "orientation": LEFT},
        "scale": named("xyz", scale),
        "color": named("rgba", rgba),
        **more,
    }


def nodes_by_key(*markers: dict[str, Any]) -> dict[str, Any]:
    """The nodes of markers that went over the wire."""
    array = decode(ARRAY, encode(ARRAY, {"markers": list(markers)}))
    return dict(nodes_of(batch_of(array.markers)))


def corners(node: Instances, row: int = 0) -> np.ndarray:
    """The axis-aligned extent of one instance, low and high (2, 3)."""
    assert node.wxyzs is not None
    half = np.abs(matrices(node.wxyzs[row]) * node.scales[row]).sum(axis=1) / 2
    return np.array([node.positions[row] - half, node.positions[row] + half])


@pytest.mark.parametrize(
    ("type_", "shape"),
    [(Marker.CUBE, "box"), (Marker.SPHERE, "sphere"), (Marker.CYLINDER, "cylinder")],
)
def test_scale_is_the_full_extent_of_a_shape(type_: int, shape: str) -> None:
    node = nodes_by_key(marker(type_, (4, 2, 1)))[shape]
    np.testing.assert_allclose(corners(node), [(9, -2, -0.5), (11, 2, 0.5)], atol=1e-6)
    assert (node.shape, node.colors, node.opacity) == (shape, (255, 0, 0), 1.0)


def test_an_arrow_begins_at_its_pose_and_its_head_is_twice_as_wide() -> None:
    nodes = nodes_by_key(marker(Marker.ARROW, (2, 0.2, 0.1)))
    shaft, head = corners(nodes["cylinder"]), corners(nodes["cone"])
    np.testing.assert_allclose(shaft, [(9.9, 0, -0.05), (10.1, 1.54, 0.05)], atol=1e-6)
    np.testing.assert_allclose(head, [(9.8, 1.54, -0.1), (10.2, 2, 0.1)], atol=1e-6)


def test_an_arrow_of_negative_length_points_back() -> None:
    node = nodes_by_key(marker(Marker.ARROW, (-2, 0.2, 0.1)))["cone"]
    np.testing.assert_allclose(corners(node), [(9.8, -2, -0.1), (10.2, -1.54, 0.1)], atol=1e-6)
    tip = np.array((0.0, 0.0, 0.5)) * node.scales[0]
    tip_position = matrices(node.wxyzs[0]) @ tip + node.positions[0]
    np.testing.assert_allclose(tip_position, (10, -2, 0), atol=1e-6)


@pytest.mark.parametrize(("head_length", "length"), [(0, 0.69), (0.5, 0.5), (9, 3)])
def test_an_arrow_between_points_has_diameters_and_the_length_of_its_head(
    head_length: float, length: float
) -> None:
    nodes = nodes_by_key(
        marker(Marker.ARROW, (0.1, 0.3, head_length), points=points((0, 0, 0), (3, 0, 0)))
    )
    np.testing.assert_allclose(nodes["cone"].scales, [(0.3, 0.3, length)], atol=1e-6)
    if head_length == 9:
        assert "cylinder" not in nodes
    else:
        shaft = corners(nodes["cylinder"])
        np.testing.assert_allclose(shaft[:, 1], (0, 3 - length), atol=1e-6)


def test_an_arrow_strip_is_an_arrow_from_each_point_to_the_next() -> None:
    path = points((0, 0, 0), (1, 0, 0), (1, 0, -1))
    nodes = nodes_by_key(marker(Marker.ARROW_STRIP, (0.1, 0.2, 0), points=path))
    np.testing.assert_allclose(
        nodes["cone"].positions, [(10, 0.875, 0), (10, 1, -0.875)], atol=1e-6
    )
    np.testing.assert_allclose(nodes["cone"].scales[:, 2], 0.25, atol=1e-6)


@pytest.mark.parametrize(
    ("type_", "key"), [(Marker.CUBE_LIST, "box data"), (Marker.SPHERE_LIST, "sphere data")]
)
def test_the_items_of_a_list_are_solids_with_a_colour_each(type_: int, key: str) -> None:
    each = colors((1, 0, 0, 1), (0, 1, 0, 0.5))
    where = points((0, 0, 0), (1, 0, 0))
    nodes = nodes_by_key(marker(type_, (4, 2, 1), (0, 0, 1, 0), points=where, colors=each))
    opaque, clear = nodes[key], nodes[f"{key} 0.502"]
    np.testing.assert_allclose(corners(opaque), [(9, -2, -0.5), (11, 2, 0.5)], atol=1e-6)
    np.testing.assert_allclose(clear.positions, [(10, 1, 0)], atol=1e-6)
    assert (opaque.colors, clear.colors, clear.opacity) == ((255, 0, 0), (0, 255, 0), 128 / 255)


def test_a_list_has_the_colour_of_the_marker_unless_there_is_one_for_each_point() -> None:
    where = points((0, 0, 0), (1, 0, 0))
    node = nodes_by_key(marker(Marker.CUBE_LIST, points=where, colors=colors((0, 1, 0, 1))))[
        "box data"
    ]
    assert node.colors == (255, 0, 0)


def test_opacity_is_linear_in_alpha() -> None:
    where = points((0, 0, 0))
    nodes = nodes_by_key(marker(Marker.SPHERE_LIST, rgba=(1, 1, 1, 0.5), points=where))
    assert [node.opacity for node in nodes.values()] == [128 / 255]


def test_many_opacities_share_a_node() -> None:
    cubes = [marker(Marker.CUBE, rgba=(1, 1, 1, i / 20)) for i in range(21)]
    nodes = nodes_by_key(*cubes)
    assert list(nodes) == ["box", "box transparent"]
    assert len(nodes["box transparent"].positions) == 19


def test_lines_have_a_width_in_metres_and_colours_at_their_ends() -> None:
    where = points((0, 0, 0), (1, 0, 0), (1, 1, 0))
    each = colors((1, 0, 0, 1), (0, 1, 0, 1), (0, 0, 1, 1))
    nodes = nodes_by_key(marker(Marker.LINE_STRIP, (0.05, 0, 0), points=where, colors=each))
    node = nodes["lines 0.05"]
    assert isinstance(node, Lines)
    expected = [[(10, 0, 0), (10, 1, 0)], [(10, 1, 0), (9, 1, 0)]]
    np.testing.assert_allclose(node.segments, expected, atol=1e-6)
    ends = [[(255, 0, 0), (0, 255, 0)], [(0, 255, 0), (0, 0, 255)]]
    np.testing.assert_array_equal(node.colors, ends)
    assert (node.width, node.unit) == (0.05, "m")


def test_strips_and_lists_of_one_width_are_one_node() -> None:
    where = points((0, 0, 0), (1, 0, 0), (2, 0, 0), (3, 0, 0))
    strips = [marker(Marker.LINE_STRIP, (0.1, 0, 0), points=where)] * 2
    nodes = nodes_by_key(*strips, marker(Marker.LINE_LIST, (0.1, 0, 0), points=where))
    assert list(nodes) == ["lines 0.1"]
    assert len(nodes["lines 0.1"].segments) == 3 + 3 + 2


def test_an_odd_list_of_lines_is_not_drawn() -> None:
    assert not nodes_by_key(
        marker(Marker.LINE_LIST, points=points((0, 0, 0), (1, 0, 0), (2, 0, 0)))
    )


def test_points_are_squares_and_each_opacity_is_a_node() -> None:
    where = points((0, 0, 0), (1, 0, 0), (2, 0, 0))
    each = colors((1, 1, 1, 1), (1, 1, 1, 0.5), (1, 1, 1, 0))
    nodes = nodes_by_key(marker(Marker.POINTS, (0.2, 0.2, 0), points=where, colors=each))
    for (key, node), (y, opacity) in zip(
        sorted(nodes.items()), [(0.0, 1.0), (1.0, 128 / 255)], strict=True
    ):
        assert isinstance(node, Points), key
        np.testing.assert_allclose(node.xyz, [(10, y, 0)], atol=1e-6)
        assert (node.colors, node.opacity) == ((255, 255, 255), opacity)
        assert (node.size, node.shape) == (0.2, "square")


def test_texts_of_one_height_are_one_node() -> None:
    texts = [
        marker(Marker.TEXT_VIEW_FACING, (0, 0, 0.3), text="ab\ncd"),
        marker(Marker.TEXT_VIEW_FACING, (0, 0, 0.3), (0, 0, 1, 1), text="\u6e2f"),
        marker(Marker.TEXT_VIEW_FACING, (0, 0, 0.3), text=" "),
    ]
    nodes = nodes_by_key(*texts)
    assert list(nodes) == ["texts 0.3"]
    node = nodes["texts 0.3"]
    assert isinstance(node, Labels)
    assert node.texts == ("ab\ncd", "\u6e2f")
    np.testing.assert_array_equal(node.colors, [(255, 0, 0), (0, 0, 255)])


@pytest.mark.parametrize(
    ("alpha", "opacity"),
    [(0.05, 0.25), (0.3, 0.25), (0.5, 0.5), (0.6, 0.5), (0.65, 0.75), (0.95, 1.0)],
)
def test_texts_keep_their_colour_at_the_nearest_of_four_opacities(
    alpha: float, opacity: float
) -> None:
    (node,) = nodes_by_key(
        marker(Marker.TEXT_VIEW_FACING, (0, 0, 0.3), (1, 0, 0, alpha), text="a")
    ).values()
    assert isinstance(node, Labels)
    assert (node.colors, node.opacity) == ((255, 0, 0), opacity)


def test_triangles_are_scaled_and_those_of_one_colour_are_one_node() -> None:
    where = points((0, 0, 0), (1, 0, 0), (0, 1, 0))
    one = marker(Marker.TRIANGLE_LIST, (2, 1, 1), points=where)
    nodes = nodes_by_key(one, one)
    (node,) = nodes.values()
    assert isinstance(node, Mesh)
    np.testing.assert_allclose(node.vertices[:3], [(10, 0, 0), (10, 2, 0), (9, 0, 0)], atol=1e-6)
    np.testing.assert_array_equal(node.faces, [(0, 1, 2), (3, 4, 5)])


def test_triangles_of_several_colours_are_one_node_with_the_id_of_each() -> None:
    where = points((0, 0, 0), (1, 0, 0), (0, 1, 0))

    def triangle(*rgba: tuple[float, float, float, float]) -> dict[str, Any]:
        return marker(Marker.TRIANGLE_LIST, points=where, colors=colors(*rgba))

    corner_by_corner = triangle((1, 0, 0, 1), (0, 1, 0, 1), (0, 0, 1, 1))
    faces = (triangle((1, 1, 0, alpha)) for alpha in (1, 0.4, 0))
    nodes = nodes_by_key(corner_by_corner, *faces)
    assert nodes.keys() == {"colorful triangles", "clear triangles"}
    whole, part = nodes["colorful triangles"], nodes["clear triangles"]
    assert isinstance(whole, Mesh)
    assert isinstance(part, Mesh)
    assert (whole.ids.tolist(), part.ids.tolist()) == ([0, 1], [2])  # pyright: ignore
    red, green, blue, yellow = (255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 0)
    corner_colors = np.array([(*rgb, 255) for rgb in (red, green, blue, yellow, yellow, yellow)])
    np.testing.assert_array_equal(whole.colors, corner_colors)
    assert np.asarray(part.colors)[part.faces[0], 3].tolist() == [102] * 3


def test_transparent_triangles_have_two_sides() -> None:
    where = points((0, 0, 0), (1, 0, 0), (0, 1, 0))
    (node,) = nodes_by_key(marker(Marker.TRIANGLE_LIST, rgba=(1, 0, 0, 0.5), points=where)).values()
    assert (len(node.faces), node.opacity) == (2, 128 / 255)


@pytest.mark.parametrize("type_", range(13))
def test_empty_and_invisible_markers_draw_nothing(type_: int) -> None:
    lists = {"points": points((0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0))}
    clear = marker(type_, rgba=(1, 1, 1, 0), text="a", **lists)
    is_shape = type_ in (Marker.ARROW, Marker.CUBE, Marker.SPHERE, Marker.CYLINDER)
    assert not nodes_by_key(clear)
    assert is_shape or not nodes_by_key(marker(type_))


def test_a_marker_is_the_same_from_one_object_and_from_the_wire() -> None:
    array = decode(ARRAY, encode(ARRAY, {"markers": [marker(Marker.CUBE)]})).markers
    again = MarkerSequence.of([array[0]])
    assert nodes_of(batch_of(again)) == nodes_of(batch_of(array))
