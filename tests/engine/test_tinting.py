"""The look of a second run: mixed with a colour, and transparent."""

from __future__ import annotations

from typing import get_args

import numpy as np
import pytest

from webviz.api.nodes import (
    Arrows,
    Axes,
    Glb,
    Image,
    Instances,
    Labels,
    Lines,
    Mesh,
    Models,
    Node,
    Pane,
    Points,
)
from webviz.api.pictures import Encoded
from webviz.data.gltf import pack, unpack
from webviz.engine.pipeline.tinting import SHARE, Tint

ONE = np.zeros((1, 3), np.float32)
TURN = np.array([[1, 0, 0, 0]], np.float32)
SEGMENT = np.zeros((1, 2, 3), np.float32)
FACE = np.zeros((1, 3), np.uint32)
RED, RED_SHARE = (255, 0, 0), round(255 * (1 - SHARE))
BLUE = Tint((0, 0, 255), 0.5)
MODEL = pack({"materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]}}]})
NODES: list[Node] = [
    Points(ONE, RED, 0.1),
    Lines(SEGMENT, RED),
    Lines(SEGMENT, None),
    Arrows(SEGMENT, RED, 0.1, 0.2, 0.2),
    Axes(ONE, TURN, 1.0, 0.1),
    Labels(ONE, ("a",), 0.2),
    Mesh(ONE, FACE, RED),
    Mesh(ONE, FACE, RED, colors=np.array([[255, 0, 0, 200]], np.uint8)),
    Instances(ONE, ONE, RED),
    Instances(ONE, ONE, RED, opacity=np.ones(1, np.float32)),
    Models(ONE, TURN, ONE, MODEL),
    Glb(MODEL),
    Image(np.full((1, 1, 4), 200, np.uint8), 1.0, 1.0),
    Image(np.zeros((1, 1), np.uint8), 1.0, 1.0, palette=np.full((256, 4), 200, np.uint8)),
]


def test_every_node_of_the_scene_has_another_look() -> None:
    assert {type(node) for node in NODES} == {*get_args(Node)} - {Pane}
    for node in NODES:
        assert BLUE(node) != node
    pane = Pane(Encoded("image/jpeg", np.zeros(1, np.uint8), 1, 1))
    assert BLUE(pane) is pane


@pytest.mark.parametrize("node", [n for n in NODES if getattr(n, "opacity", None) is not None])
def test_opacities_are_multiplied(node: Node) -> None:
    assert np.all(np.asarray(BLUE(node).opacity) == 0.5 * np.asarray(node.opacity))  # pyright: ignore


def test_colours_are_mixed_of_one_and_of_many() -> None:
    mixed = (RED_SHARE, 0, round(255 * SHARE))
    assert BLUE(Points(ONE, RED, 0.1)).colors == mixed  # pyright: ignore[reportAttributeAccessIssue]
    many = BLUE(Points(ONE, np.array([RED], np.uint8), 0.1))
    np.testing.assert_allclose(many.colors, [mixed], atol=1)  # pyright: ignore
    vertex = np.asarray(BLUE(NODES[7]).colors)  # pyright: ignore[reportAttributeAccessIssue]
    np.testing.assert_allclose(vertex, [[*mixed, 100]], atol=1)


def test_axes_keep_their_length_and_their_colours_apart() -> None:
    turned = np.array([[np.sqrt(0.5), 0, 0, np.sqrt(0.5)]], np.float32)
    lines = BLUE(Axes(ONE + 1, turned, 2.0, 0.1, ids=np.array([7])))
    assert isinstance(lines, Lines)
    tips = [[1, 3, 1], [-1, 1, 1], [1, 1, 3]]  # x points to the left
    np.testing.assert_allclose(lines.segments[:, 1], tips, atol=1e-6)
    assert lines.ids is not None
    assert lines.ids.tolist() == [7, 7, 7]
    assert len({tuple(colors[0]) for colors in np.asarray(lines.colors)}) == 3


def test_materials_of_models_are_mixed_and_blended() -> None:
    document, _ = unpack(BLUE(Glb(MODEL)).data)  # pyright: ignore[reportAttributeAccessIssue]
    (material,) = document["materials"]
    assert material["alphaMode"] == "BLEND"
    factor = material["pbrMetallicRoughness"]["baseColorFactor"]
    assert factor == pytest.approx([1 - SHARE, 0.0, SHARE, 0.5])
    broken = Glb(b"not a model")
    assert BLUE(broken) == broken


def test_without_a_colour_only_opacities_change() -> None:
    faint = Tint(None, 0.5)
    assert faint(Points(ONE, RED, 0.1)) == Points(ONE, RED, 0.1, opacity=0.5)
    assert faint(Mesh(ONE, FACE, RED)) == Mesh(ONE, FACE, RED, 0.5)
    assert faint(Labels(ONE, ("a",), 0.2)) == Labels(ONE, ("a",), 0.2, opacity=0.5)


def test_transparent_arrows_are_a_mesh_of_the_same_extent_and_ids() -> None:
    segments = np.array([[[0, 0, 0], [0, 0, 2]], [[1, 0, 0], [1, 0, 0]]], np.float32)
    mesh = BLUE(Arrows(segments, RED, 0.1, 0.3, 0.5, ids=np.array([4, 9])))
    assert isinstance(mesh, Mesh)
    assert mesh.ids is not None
    first, second = np.split(mesh.vertices, 2)
    assert (second[:, 0] == 1).all(), "An arrow without a direction is flat, and finite."
    np.testing.assert_allclose(
        [first.min(axis=0), first.max(axis=0)], [[-0.3, -0.3, 0], [0.3, 0.3, 2]], atol=0.05
    )
    triangles = mesh.vertices[mesh.faces[mesh.ids == 4]].astype(np.float64)
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    volume = (triangles.mean(axis=1) * normals).sum() / 6
    octagon = 8 * np.sin(np.pi / 4) / 2
    assert volume == pytest.approx(octagon * (0.1**2 * 1.5 + 0.3**2 * 0.5 / 3), rel=1e-3)
    np.testing.assert_array_equal(np.asarray(mesh.colors)[:, 3], 128)
    opaque = Tint((0, 0, 255), 1.0)(Arrows(segments, RED, 0.1, 0.3, 0.5))
    assert isinstance(opaque, Arrows)
