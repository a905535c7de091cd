"""Binary glTF: valid, and recoloured without touching the geometry."""

from __future__ import annotations

import io
import json
import struct

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from webviz_urdf import glb_with
from webviz_urdf.glb import MeshPart, Surface, write_glb

VERTICES = np.array(((0, 0, 0), (1, 0, 0), (0, 1, 0)), np.float32)
FACES = np.array(((0, 1, 2),), np.uint32)
GREEN = Surface((0.0, 0.5, 0.0, 1.0))
HALF = Surface((1.0, 0.0, 0.0, 0.5))


@pytest.fixture
def two_parts() -> bytes:
    colors = np.full((3, 4), 255, np.uint8)
    return write_glb(
        [MeshPart(VERTICES, FACES, GREEN), MeshPart(VERTICES + 1, FACES, HALF, colors=colors)]
    )


def document(data: bytes) -> dict:
    (length,) = struct.unpack_from("<I", data, 12)
    return json.loads(data[20 : 20 + length])


def factors(data: bytes) -> list[list[float]]:
    materials = document(data)["materials"]
    return [material["pbrMetallicRoughness"]["baseColorFactor"] for material in materials]


def test_chunks_are_aligned_and_lengths_true(two_parts: bytes) -> None:
    _, version, total, length, _ = struct.unpack_from("<5I", two_parts)
    (binary,) = struct.unpack_from("<I", two_parts, 20 + length)
    assert (version, total, length % 4, binary % 4) == (2, len(two_parts), 0, 0)
    assert 28 + length + binary == total
    assert document(two_parts)["buffers"][0]["byteLength"] == binary


def test_another_reader_sees_the_same_triangles(two_parts: bytes) -> None:
    scene = trimesh.load_scene(io.BytesIO(two_parts), "glb", process=False)
    assert scene.bounds.tolist() == [[0, 0, 0], [2, 2, 1]]
    assert sum(len(mesh.faces) for mesh in scene.geometry.values()) == 2


def test_colours_are_stored_as_linear_light(two_parts: bytes) -> None:
    # sRGB 0.5 is 0.21404 of full light.
    np.testing.assert_allclose(factors(two_parts)[0], (0, 0.21404, 0, 1), atol=1e-4)


def test_parts_of_one_surface_share_a_material() -> None:
    data = write_glb(
        [MeshPart(VERTICES, FACES, GREEN), MeshPart(VERTICES, FACES, Surface(GREEN.rgba))]
    )
    assert len(document(data)["materials"]) == 1


def test_only_transparent_surfaces_are_blended(two_parts: bytes) -> None:
    modes = [material.get("alphaMode") for material in document(two_parts)["materials"]]
    assert modes == [None, "BLEND"]


@given(st.floats(0, 1))
def test_alpha_multiplies_that_of_each_material(alpha: float) -> None:
    data = write_glb([MeshPart(VERTICES, FACES, GREEN), MeshPart(VERTICES, FACES, HALF)])
    changed = glb_with(data, alpha=alpha)
    assert [factor[3] for factor in factors(changed)] == pytest.approx([alpha, alpha / 2])


def test_alpha_one_leaves_an_opaque_material_opaque() -> None:
    changed = glb_with(write_glb([MeshPart(VERTICES, FACES, GREEN)]), alpha=1.0)
    assert "alphaMode" not in document(changed)["materials"][0]


def test_a_colour_replaces_colours_textures_and_vertex_colours() -> None:
    uvs = np.zeros((3, 2), np.float32)
    picture = Surface(texture=b"\x89PNG")
    colors = np.full((3, 4), 255, np.uint8)
    data = write_glb(
        [
            MeshPart(VERTICES, FACES, picture, uvs=uvs),
            MeshPart(VERTICES, FACES, HALF, colors=colors),
        ]
    )
    assert b"COLOR_0" in data
    changed = document(glb_with(data, color=(255, 255, 255)))
    assert "baseColorTexture" not in json.dumps(changed["materials"])
    assert "COLOR_0" not in json.dumps(changed["meshes"])
    assert factors(glb_with(data, color=(255, 255, 255))) == [[1, 1, 1, 1], [1, 1, 1, 0.5]]


def test_recolouring_keeps_the_geometry_and_the_original(two_parts: bytes) -> None:
    before = bytes(two_parts)
    changed = glb_with(two_parts, alpha=0.5, color=(9, 9, 9))
    assert two_parts == before
    scene = trimesh.load_scene(io.BytesIO(changed), "glb", process=False)
    assert scene.bounds.tolist() == [[0, 0, 0], [2, 2, 1]]


@pytest.mark.parametrize("data", [b"", b"glTF", b"x" * 100])
def test_an_invalid_glb_is_refused(data: bytes) -> None:
    with pytest.raises(ValueError, match="not a binary glTF"):
        glb_with(data, alpha=0.5)


@pytest.mark.parametrize("text", [b"{", b'{"a": "\xff"}', b"[" * 100_000])
def test_invalid_json_in_a_glb_is_refused(text: bytes) -> None:
    data = b"glTF\x02\0\0\0" + struct.pack("<II", 20 + len(text), len(text)) + b"JSON" + text
    with pytest.raises(ValueError, match="JSON of the binary glTF is invalid"):
        glb_with(data, alpha=0.5)
