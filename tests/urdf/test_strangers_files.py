"""Meshes and descriptions of other programs: exporters, axes, colours, encodings."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest
import trimesh
from PIL import Image
from trimesh.visual import TextureVisuals
from trimesh.visual.material import PBRMaterial

from webviz_urdf import Resolver, RobotDescriptionError
from webviz_urdf.load import load_file
from webviz_urdf.meshes import HEADER, TRIANGLE, MeshError, read_mesh
from webviz_urdf.textures import without_options

REPORTS = Path(__file__).parents[3] / "shared/data/reports"
needs_reports = pytest.mark.skipif(not REPORTS.is_dir(), reason="needs ../shared/data/reports")


def triangles(path: Path) -> int:
    parts = read_mesh(path, Resolver(roots=[path.parent])).parts
    return sum(len(part.faces) for part in parts)


def bounds(path: Path) -> np.ndarray:
    parts = read_mesh(path, Resolver(roots=[path.parent])).parts
    vertices = np.concatenate([part.vertices for part in parts])
    return np.array((vertices.min(axis=0), vertices.max(axis=0)))


@pytest.fixture
def stl() -> bytes:
    data = trimesh.creation.box((1, 1, 1)).export(file_type="stl")
    assert isinstance(data, bytes)
    return data


@needs_reports
@pytest.mark.parametrize("path", sorted((REPORTS / "U5").glob("*.stl")), ids=lambda path: path.name)
def test_stl_files_of_other_programs_are_read_whole(path: Path) -> None:
    assert triangles(path) == (24 if path.stem == "two_solids" else 12)


@pytest.mark.parametrize("rest", [b"\0", b"made by a tool", bytes(TRIANGLE)])
def test_bytes_behind_the_triangles_are_ignored(tmp_path: Path, stl: bytes, rest: bytes) -> None:
    (path := tmp_path / "a.stl").write_bytes(stl + rest)
    assert triangles(path) == 12


def test_a_count_of_zero_is_that_of_the_bytes(tmp_path: Path, stl: bytes) -> None:
    (path := tmp_path / "a.stl").write_bytes(
        stl[: HEADER - 4] + struct.pack("<I", 0) + stl[HEADER:]
    )
    assert triangles(path) == 12


def test_a_truncated_file_is_reported(tmp_path: Path, stl: bytes) -> None:
    (path := tmp_path / "a.stl").write_bytes(stl[:-1])
    with pytest.raises(MeshError, match="cut off after 11 of 12 triangles"):
        triangles(path)


@needs_reports
@pytest.mark.parametrize("name", ["tower.glb", "tower.gltf"])
def test_gltf_stands_upright(name: str) -> None:
    expected = [(-0.2, -1.2, 0.0), (0.2, 0.2, 3.0)]
    np.testing.assert_allclose(bounds(REPORTS / "U1" / name), expected, atol=1e-6)


def glb_of(tmp_path: Path, mode: str | None, factor: list[float]) -> Path:
    material = PBRMaterial(baseColorFactor=factor, alphaMode=mode)
    box = trimesh.creation.box((1, 1, 1))
    visual = TextureVisuals(uv=np.zeros((8, 2)), material=material)
    box.visual = visual
    path = tmp_path / "a.glb"
    trimesh.Scene(box).export(path)
    return path


@pytest.mark.parametrize(
    ("mode", "alpha"), [("OPAQUE", 1.0), (None, 1.0), ("MASK", 1.0), ("BLEND", 0.3)]
)
def test_alpha_counts_in_the_mode_blend_only(
    tmp_path: Path, mode: str | None, alpha: float
) -> None:
    path = glb_of(tmp_path, mode, [1.0, 0.0, 0.0, 0.3])
    (part,) = read_mesh(path, Resolver(roots=[tmp_path])).parts
    assert part.surface is not None
    assert part.surface.rgba == pytest.approx((1.0, 0.0, 0.0, alpha), abs=0.01)


def test_the_factor_of_a_colour_is_linear_light(tmp_path: Path) -> None:
    path = glb_of(tmp_path, None, [0.5, 0.5, 0.5, 1.0])
    (part,) = read_mesh(path, Resolver(roots=[tmp_path])).parts
    assert part.surface is not None
    assert round(255 * part.surface.rgba[0]) == pytest.approx(188, abs=1)


@needs_reports
def test_opaque_materials_of_files_are_opaque() -> None:
    (part,) = read_mesh(REPORTS / "U1/opaque_mode.glb", Resolver(roots=[REPORTS])).parts
    assert part.surface is not None
    assert part.surface.rgba[3] == 1.0


@pytest.mark.parametrize(
    ("line", "name"),
    [
        ("a.png", "a.png"),
        ("my picture.png", "my picture.png"),
        ("-s 1 1 1 a.png", "a.png"),
        ("-o 0.5 -s 2 2 a b.png", "a b.png"),
        ("-clamp on -bm 0.2 -mm 0 1 a.png", "a.png"),
        ("-imfchan r -s 1 10.png", "10.png"),
        ("-texres 512", "-texres 512"),
        ("-s 1 1 1 1.png", "1.png"),
        ("-strange a.png", "-strange a.png"),
    ],
)
def test_options_before_the_texture_of_an_mtl_file_are_ignored(line: str, name: str) -> None:
    expected = name if line != "-texres 512" else "512"
    assert without_options(line) == expected


def test_a_texture_with_options_is_drawn(tmp_path: Path) -> None:
    Image.new("RGB", (2, 2), (255, 0, 0)).save(tmp_path / "a.png")
    (tmp_path / "a.mtl").write_text("newmtl m\nKd 1 1 1\nmap_Kd -s 1 1 1 a.png\n")
    path = tmp_path / "a.obj"
    path.write_text(
        "mtllib a.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n"
    )
    content = read_mesh(path, Resolver(roots=[tmp_path]))
    assert content.warnings == ()
    assert content.parts[0].surface is not None
    assert content.parts[0].surface.texture is not None


@pytest.mark.parametrize("encoding", ["ISO-8859-1", "windows-1252", "utf-8", "utf-16", "utf-8-sig"])
def test_a_description_has_the_encoding_that_it_declares(tmp_path: Path, encoding: str) -> None:
    declared = encoding.removesuffix("-sig")
    text = f"<?xml version='1.0' encoding='{declared}'?><robot name='r'><link name='Tür'/></robot>"
    (path := tmp_path / "a.urdf").write_bytes(text.encode(encoding))
    assert "Tür" in load_file(path).links


@pytest.mark.parametrize("encoding", ["klingon", "idna", "zlib_codec", "utf-7-x"])
def test_an_unknown_encoding_is_a_sentence(tmp_path: Path, encoding: str) -> None:
    (path := tmp_path / "a.urdf").write_text(f"<?xml version='1.0' encoding='{encoding}'?><robot/>")
    with pytest.raises(RobotDescriptionError):
        load_file(path)
