"""Meshes and textures of markers."""

from __future__ import annotations

import gc
import io
from itertools import takewhile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from inspecting import Benches
from PIL import Image

from webviz import Glb, Instances, Models
from webviz.data.messages import Marker, MarkerSequence
from webviz.data.messages.geometry import Vector3
from webviz.data.messages.markers import ColorRGBA
from webviz_displays.markers import MarkerArray, assets, meshes
from webviz_displays.markers.batch import batch_of
from webviz_displays.markers.faults import faults_of
from webviz_displays.markers.meshes import LoadedMesh
from webviz_displays.markers.nodes import Files, nodes_of
from webviz_urdf import MeshContent, MeshPart, Surface

ARRAY = "visualization_msgs/msg/MarkerArray"
CORNERS = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0)], np.float32)
FACE = np.array([(0, 1, 2)], np.uint32)
GREEN = MeshPart(CORNERS, FACE, Surface((0.0, 1.0, 0.0, 1.0)))
PAINTED = MeshPart(CORNERS, FACE, colors=np.full((3, 4), 255, np.uint8))

NO_TINT = (1.0, 1.0, 1.0, 1.0)


def mesh_nodes(
    *markers: tuple[tuple[float, ...], bool], part: MeshPart = GREEN, scale: float = 1.0
) -> dict[str, Any]:
    """The nodes of markers with a colour, and whether they keep the materials of one file."""
    mesh = LoadedMesh("file", MeshContent((part,)))
    each = [
        Marker(
            type=Marker.MESH_RESOURCE,
            scale=Vector3(scale, 1.0, 1.0),
            color=ColorRGBA(*rgba),
            mesh_use_embedded_materials=own,
        )
        for rgba, own in markers
    ]
    files = Files(meshes=dict.fromkeys(range(len(each)), mesh))
    return dict(nodes_of(batch_of(MarkerSequence.of(each)), files))


def test_meshes_of_one_file_are_one_node_with_a_colour_each() -> None:
    (node,) = mesh_nodes(((1, 0, 0, 1), False), ((0, 0, 1, 1), False)).values()
    assert isinstance(node, Instances)
    np.testing.assert_array_equal(node.colors, [(255, 0, 0), (0, 0, 255)])
    np.testing.assert_array_equal(node.shape.vertices, CORNERS)  # pyright: ignore[reportAttributeAccessIssue]


def test_a_mesh_without_materials_is_white_unless_the_marker_has_a_colour() -> None:
    part = MeshPart(CORNERS, FACE)
    (node,) = mesh_nodes(((0, 0, 0, 0), True), ((1, 0, 0, 1), True), part=part).values()
    np.testing.assert_array_equal(node.colors, [(255, 255, 255), (255, 0, 0)])
    assert node.opacity == 1.0


@pytest.mark.parametrize(
    ("rgba", "own", "is_seen"),
    [((0, 0, 0, 0), True, True), ((0, 0, 0, 0), False, False), ((1, 0, 0, 0), True, False)],
)
def test_a_mesh_with_zero_alpha_has_a_status(
    rgba: tuple[float, ...], own: bool, is_seen: bool
) -> None:
    marker = Marker(
        type=Marker.MESH_RESOURCE,
        scale=Vector3(1.0, 1.0, 1.0),
        color=ColorRGBA(*rgba),
        mesh_resource="file:///a.stl",
        mesh_use_embedded_materials=own,
    )
    texts = [text for _, _, text in faults_of(batch_of(MarkerSequence.of([marker])))]
    assert texts == ([] if is_seen else ["It is invisible: alpha of the color is 0. Set it to 1."])


@pytest.mark.parametrize(
    ("rgba", "color", "opacity"),
    [
        ((0, 0, 0, 0), (0, 255, 0), 1.0),
        ((1, 1, 1, 1), (0, 255, 0), 1.0),
        ((0, 0, 0, 0.2), (0, 255, 0), 51 / 255),
        ((1, 0.2, 1, 0.2), (0, 51, 0), 51 / 255),
    ],
)
def test_a_colour_multiplies_the_materials_of_the_file(
    rgba: tuple[float, ...], color: tuple[int, int, int], opacity: float
) -> None:
    (node,) = mesh_nodes((rgba, True)).values()
    assert (node.colors, node.opacity) == (color, opacity)


def test_a_mesh_without_a_material_has_the_colour_of_the_marker() -> None:
    part = MeshPart(CORNERS, FACE)
    (node,) = mesh_nodes(((0.2, 0, 1, 1), True), part=part).values()
    assert node.colors == (51, 0, 255)


def test_a_mirrored_mesh_still_has_its_outside_outside() -> None:
    (node,) = mesh_nodes(((1, 0, 0, 1), False), scale=-2.0).values()
    a, b, c = (node.shape.vertices * node.scales[0])[node.shape.faces[0]]
    assert np.cross(b - a, c - a)[2] > 0.0
    assert {tuple(row) for row in (node.shape.vertices * node.scales[0]).tolist()} == {
        (0.0, 0.0, 0.0),
        (-2.0, 0.0, 0.0),
        (0.0, 1.0, 0.0),
    }


def test_copies_of_a_painted_mesh_are_one_node_for_each_tint() -> None:
    white, red = (1.0, 1.0, 1.0, 1.0), (1.0, 0.0, 0.0, 1.0)
    nodes = mesh_nodes((white, True), (red, True), (white, True), part=PAINTED)
    assert all(isinstance(node, Models) for node in nodes.values())
    assert sorted(len(node.positions) for node in nodes.values()) == [1, 2]


def test_models_of_ever_new_colours_are_not_kept_for_ever(monkeypatch: pytest.MonkeyPatch) -> None:
    mesh = LoadedMesh("file", MeshContent((PAINTED,)))
    first = mesh.model(0, NO_TINT)
    monkeypatch.setattr(meshes, "MAX_MODELS", 3 * len(first))
    assert mesh.model(0, NO_TINT) is first
    tints = [(shade / 100, 1.0, 1.0, 1.0) for shade in range(1, 100)]
    models = [(tint, mesh.model(0, tint)) for tint in tints]
    # The newest are kept; to ask for one that is not would make it anew, and lose another.
    cached = takewhile(lambda entry: mesh.model(0, entry[0]) is entry[1], reversed(models))
    assert 0 < sum(len(model) for _, model in cached) <= meshes.MAX_MODELS
    assert mesh.model(0, NO_TINT) is not first


# Files


def marker(**more: Any) -> dict[str, Any]:
    one = {"x": 1.0, "y": 1.0, "z": 1.0}
    return {"header": {"frame_id": "map"}, "scale": one, "color": {"r": 1.0, "a": 1.0}, **more}


def test_meshes_and_pictures_in_a_message_are_drawn_and_broken_ones_named(bench: Benches) -> None:
    stl = trimesh.creation.box().export(file_type="stl")
    png = io.BytesIO()
    Image.new("RGB", (2, 2), (255, 0, 0)).save(png, "PNG")
    triangle = {
        "type": 11,
        "points": [{}, {"x": 1.0}, {"y": 1.0}],
        "uv_coordinates": [{}, {"u": 1.0}, {"v": 1.0}],
        "texture_resource": "embedded://red.png",
    }
    mesh = {"type": 10, "mesh_resource": "embedded://a.stl"}
    markers = [
        marker(id=1, **mesh, mesh_file={"filename": "a.stl", "data": stl}),
        marker(id=2, **triangle, texture={"format": "png", "data": png.getvalue()}),
        marker(id=3, **mesh, mesh_file={"filename": "b.stl", "data": b"no mesh"}),
        marker(id=4, **mesh),
        marker(id=5, **triangle, texture={"format": "png", "data": b"no picture"}),
        marker(id=6, type=10, mesh_resource="http://example.org/a.stl"),
        marker(id=7, **(triangle | {"uv_coordinates": []})),
    ]
    at = bench(MarkerArray())
    at.send(ARRAY, {"markers": markers})
    at.turn()
    at.settle()
    nodes = at.nodes()
    (ball,) = (node for node in nodes.values() if isinstance(node, Instances))
    assert len(ball.shape.faces) == 12  # pyright: ignore[reportAttributeAccessIssue]
    assert sum(isinstance(node, Glb) for node in nodes.values()) == 1
    statuses = at.statuses()
    for id, sentence in (
        (3, "b.stl"),
        (4, "mesh_file.data is empty"),
        (5, "red.png"),
        (6, "is on a network"),
        (7, "0 for 3 points"),
    ):
        level, text = statuses[f"Marker /{id}"]
        assert (level, sentence in text) == ("ERROR", True), text
    assert "Marker /1" not in statuses
    assert "Marker /2" not in statuses


def test_a_file_that_failed_to_load_is_tried_again(
    bench: Benches, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    package = tmp_path / "share" / "late"
    package.mkdir(parents=True)
    at = bench(MarkerArray())
    mesh = marker(id=1, type=10, mesh_resource="package://late/late.stl")
    at.send(ARRAY, {"markers": [mesh]})
    with monkeypatch.context() as patch:
        patch.setattr(assets, "RETRY_S", 0.0)
        at.turn()
        at.settle()
    assert "late.stl" in at.statuses()["Marker /1"][1]
    trimesh.creation.box().export(package / "late.stl")
    at.turn()
    assert "Loading" not in at.statuses()
    at.settle()
    assert "Marker /1" not in at.statuses()
    assert len(at.nodes()) == 1


def loaded_meshes() -> int:
    """The meshes in memory."""
    gc.collect()
    return sum(type(each) is LoadedMesh for each in gc.get_objects())


def test_an_embedded_mesh_is_freed_with_its_message(bench: Benches) -> None:
    at = bench(MarkerArray())
    before = loaded_meshes()
    for edge in range(1, 6):
        stl = trimesh.creation.box((edge, 1.0, 1.0)).export(file_type="stl")
        file = {"filename": "a.stl", "data": stl}
        one = marker(id=1, type=10, mesh_resource="embedded://a.stl", mesh_file=file)
        at.send(ARRAY, {"markers": [one]})
        at.turn()
        at.settle()
        at.turn()
    assert 1 <= loaded_meshes() - before <= 2
