"""Mesh files: units, axes, scales, materials, and files that are broken."""

from __future__ import annotations

import io
import json
import zipfile
from pathlib import Path

import numpy as np
import pytest
import trimesh
from PIL import Image
from small_robots import (
    TEXTURED,
    as_trimesh,
    load,
    one_mesh,
    only_glb,
    only_mesh,
    only_node,
    tetrahedron_dae,
)
from trimesh.exchange.ply import export_ply
from trimesh.visual import ColorVisuals

from webviz.api.nodes import Glb, Mesh
from webviz_urdf import Resolver, build, load_robot, meshes
from webviz_urdf.files import read_file
from webviz_urdf.meshes import read_mesh

DAE = sorted((Path(__file__).parents[3] / "shared/data/mesh").glob("*.dae"))
LFS_POINTER = b"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n"
URDF_BLUE = "<material name='b'><color rgba='0 0 1 1'/></material>"


@pytest.fixture
def stl(tmp_path: Path) -> Path:
    path = tmp_path / "box.stl"
    trimesh.creation.box((1, 2, 3)).export(path)
    return path


@pytest.mark.parametrize("unit", ["1", "0.01", "0.0254", "0.00254"])
@pytest.mark.parametrize("up", ["X_UP", "Y_UP", "Z_UP"])
def test_the_unit_of_a_collada_file_is_applied_and_its_up_axis_is_not(
    tmp_path: Path, unit: str, up: str
) -> None:
    path = tmp_path / "t.dae"
    path.write_text(tetrahedron_dae(unit, up))
    extents = as_trimesh(only_node(one_mesh(path))).extents
    np.testing.assert_allclose(extents, np.array((1, 2, 3)) * float(unit), rtol=1e-6)


def test_the_scale_of_the_description_multiplies_the_unit(tmp_path: Path) -> None:
    path = tmp_path / "t.dae"
    path.write_text(tetrahedron_dae("0.01"))
    extents = as_trimesh(only_node(one_mesh(path, "scale='10 20 30'"))).extents
    np.testing.assert_allclose(extents, (0.1, 0.4, 0.9), rtol=1e-6)


@pytest.mark.parametrize("scale", ["1 1 1", "-1 1 1", "1 -2 1", "-1 -1 1", "-1 -1 -1"])
@pytest.mark.parametrize("name", ["t.dae", "t.stl"])
def test_a_mirrored_mesh_keeps_its_outside_outside(tmp_path: Path, scale: str, name: str) -> None:
    path = tmp_path / name
    if name == "t.dae":
        path.write_text(tetrahedron_dae())
    else:
        trimesh.creation.cone(1, 2).export(path)
    node = only_node(one_mesh(path, f"scale='{scale}'"))
    assert as_trimesh(node).volume > 0.5


def test_normals_of_a_mirrored_mesh_point_outwards(tmp_path: Path) -> None:
    ball = trimesh.creation.icosphere()
    ball.visual = ColorVisuals(ball, vertex_colors=np.tile((0, 255, 0, 255), (642, 1)))
    path = tmp_path / "ball.ply"
    path.write_bytes(export_ply(ball, vertex_normal=True))
    node = only_glb(one_mesh(path, "scale='-1 2 3'"))
    scene = trimesh.load_scene(io.BytesIO(node.data), "glb", process=False)
    (mesh,) = scene.geometry.values()
    assert (np.einsum("ij,ij->i", mesh.vertices, mesh.vertex_normals) > 0).all()
    np.testing.assert_allclose(np.linalg.norm(mesh.vertex_normals, axis=1), 1, rtol=1e-5)


def test_a_flattened_mesh_is_drawn_flat(stl: Path) -> None:
    assert as_trimesh(only_node(one_mesh(stl, "scale='1 1 0'"))).extents.tolist() == [1, 2, 0]


def test_one_number_as_scale_counts_for_all_axes(stl: Path) -> None:
    assert as_trimesh(only_node(one_mesh(stl, "scale='2'"))).extents.tolist() == [2, 4, 6]


@pytest.mark.parametrize("suffix", ["STL", "Stl"])
def test_suffixes_may_be_in_capitals(stl: Path, suffix: str) -> None:
    path = stl.rename(stl.with_suffix(f".{suffix}"))
    assert isinstance(only_node(one_mesh(path)), Mesh)


def test_an_stl_file_has_the_material_of_the_description(stl: Path) -> None:
    assert only_mesh(one_mesh(stl, material=URDF_BLUE)).color == (0, 0, 255)


def test_facets_of_a_file_without_normals_share_no_corners(stl: Path) -> None:
    node = only_mesh(one_mesh(stl))
    assert len(node.vertices) == 3 * len(node.faces) == 36
    assert node.vertices.dtype == np.float32
    assert node.faces.dtype == np.uint32


def test_the_own_colour_of_a_collada_file_wins(tmp_path: Path) -> None:
    path = tmp_path / "t.dae"
    path.write_text(tetrahedron_dae())
    assert only_mesh(one_mesh(path, material=URDF_BLUE)).color == (0, 255, 0)


def test_a_collada_body_without_a_material_has_that_of_the_description(tmp_path: Path) -> None:
    path = tmp_path / "t.dae"
    path.write_text(tetrahedron_dae(bound=False))
    assert only_mesh(one_mesh(path, material=URDF_BLUE)).color == (0, 0, 255)


@pytest.mark.parametrize("name", ["sub/picture.png", "sub\\picture.png", "C:\\author\\picture.png"])
def test_the_texture_of_a_collada_file_is_kept(tmp_path: Path, name: str) -> None:
    Image.new("RGB", (3, 5), (0, 0, 255)).save(tmp_path / "picture.png")
    (tmp_path / "sub").mkdir()
    Image.new("RGB", (3, 5), (0, 0, 255)).save(tmp_path / "sub/picture.png")
    path = tmp_path / "t.dae"
    path.write_text(tetrahedron_dae(effects=TEXTURED, image=name))
    node = only_glb(
        one_mesh(path, material="<material name='r'><color rgba='1 0 0 1'/></material>")
    )
    scene = trimesh.load_scene(io.BytesIO(node.data), "glb", process=False)
    (mesh,) = scene.geometry.values()
    assert mesh.visual.material.baseColorTexture.size == (3, 5)
    # The corner at x = 1 has the picture's lower right corner.
    corner = mesh.visual.uv[np.isclose(mesh.vertices[:, 0], 1)]
    np.testing.assert_allclose(corner, np.tile((1, 0), (len(corner), 1)), atol=1e-6)


def test_a_texture_that_is_not_there_is_named_and_the_body_is_shown(tmp_path: Path) -> None:
    path = tmp_path / "t.dae"
    path.write_text(tetrahedron_dae(effects=TEXTURED, image="gone.png"))
    robot = one_mesh(path)
    assert isinstance(only_node(robot), Mesh)
    assert "'gone.png'" in robot.warnings[0]


def test_a_body_whose_material_refers_to_nothing_is_shown(tmp_path: Path) -> None:
    path = tmp_path / "t.dae"
    path.write_text(tetrahedron_dae(effects=TEXTURED))  # no <image id="i">
    robot = one_mesh(path, material=URDF_BLUE)
    assert only_mesh(robot).color == (0, 0, 255)
    assert as_trimesh(only_node(robot)).extents.tolist() == [1, 2, 3]
    assert "Material 'm'" in robot.warnings[0]


def test_an_obj_file_keeps_colours_and_textures_of_its_mtl(tmp_path: Path) -> None:
    Image.new("RGB", (2, 2), (255, 255, 0)).save(tmp_path / "p.jpg")
    (tmp_path / "m.mtl").write_text(
        "newmtl green\nKd 0 1 0\nnewmtl picture\nKd 1 1 1\nmap_Kd p.jpg\n"
    )
    faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl {}\nf 1/1 2/2 3/3\n"
    path = tmp_path / "a.obj"
    path.write_text("mtllib m.mtl\n" + faces.format("green"))
    assert only_mesh(one_mesh(path, material=URDF_BLUE)).color == (0, 255, 0)
    path = tmp_path / "b.obj"
    path.write_text("mtllib m.mtl\n" + faces.format("picture"))
    assert b"image/jpeg" in only_glb(one_mesh(path)).data


def test_an_obj_file_without_materials_has_that_of_the_description(tmp_path: Path) -> None:
    path = tmp_path / "a.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n")
    assert only_mesh(one_mesh(path, material=URDF_BLUE)).color == (0, 0, 255)


def test_vertex_colours_are_kept_in_a_glb(tmp_path: Path) -> None:
    mesh = trimesh.creation.box()
    mesh.visual = ColorVisuals(mesh, vertex_colors=np.tile((0, 255, 0, 255), (8, 1)))
    path = tmp_path / "a.ply"
    mesh.export(path)
    node = only_node(one_mesh(path, material=URDF_BLUE))
    assert isinstance(node, Glb)
    assert b"COLOR_0" in node.data


def test_a_mesh_used_again_is_the_same_node(stl: Path) -> None:
    mesh = f"<visual><geometry><mesh filename='{stl}'/></geometry></visual>"
    other = f"<visual><geometry><mesh filename='{stl}' scale='2 2 2'/></geometry></visual>"
    robot = load(f"<robot name='r'><link name='l'>{mesh}{mesh}{other}</link></robot>", stl.parent)
    first, second, third = (shape.node for shape in robot.links["l"].visuals)
    assert first is second
    assert first is not third


def test_a_missing_mesh_is_listed_with_its_reason_and_the_rest_is_shown() -> None:
    robot = load(
        "<robot name='r'><link name='l'>"
        "<visual><geometry><mesh filename='package://gone/a.stl'/></geometry></visual>"
        "<visual><geometry><box size='1 1 1'/></geometry></visual>"
        "<collision><geometry><mesh filename='http://example.org/a.stl'/></geometry></collision>"
        "</link></robot>"
    )
    assert len(robot.links["l"].visuals) == 1
    first, second = robot.missing
    assert (first.link, first.uri, first.kind) == ("l", "package://gone/a.stl", "visual")
    assert "Package 'gone'" in first.reason
    assert (second.kind, second.uri) == ("collision", "http://example.org/a.stl")


@pytest.mark.parametrize("name", ["a.dae", "a.stl", "a.obj", "a.ply", "a.glb", "a.mesh", "a"])
@pytest.mark.parametrize("content", [b"", b"garbage", bytes(range(256)) * 9, b"<COLLADA/>"])
def test_a_broken_mesh_file_is_missing_with_a_reason_in_one_line(
    tmp_path: Path, name: str, content: bytes
) -> None:
    path = tmp_path / name
    path.write_bytes(content)
    (missing,) = one_mesh(path).missing
    assert name in missing.reason
    assert "\n" not in missing.reason


@pytest.mark.parametrize(
    ("before", "after"), [(b"  \n", b""), (b"", b"\0\0 7 8 <"), (b"\n", b"\0")]
)
def test_space_before_a_collada_file_and_bytes_after_a_nul_are_ignored(
    tmp_path: Path, before: bytes, after: bytes
) -> None:
    path = tmp_path / "a.dae"
    path.write_bytes(before + tetrahedron_dae().encode() + after)
    assert only_node(one_mesh(path)) is not None


@pytest.mark.skipif(not DAE, reason="the COLLADA files of other people are absent")
@pytest.mark.parametrize("path", DAE or [None], ids=lambda path: path.stem if path else "none")
def test_real_collada_files_that_are_not_quite_xml_are_read(path: Path) -> None:
    (part,) = read_mesh(path, Resolver()).parts
    assert len(part.faces) in (6742, 18470)


@pytest.mark.parametrize("name", ["a.dae", "a.stl", "a.png", "a.urdf"])
def test_a_pointer_of_git_lfs_is_named(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    path.write_bytes(LFS_POINTER)
    with pytest.raises(OSError, match="pointer of Git LFS") as error:
        read_file(path, 1000)
    assert "run `git lfs pull`" in str(error.value.strerror)


def test_a_mesh_that_is_a_pointer_of_git_lfs_is_missing_with_the_remedy(tmp_path: Path) -> None:
    path = tmp_path / "a.stl"
    path.write_bytes(LFS_POINTER)
    (missing,) = one_mesh(path).missing
    assert "cannot be read: it is a pointer of Git LFS; run `git lfs pull`" in missing.reason


@pytest.mark.parametrize("name", ["a.zae", "a.zip", "a.3mf", "a.stl.gz"])
def test_archives_are_refused_and_the_formats_named(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("a.dae", "<COLLADA/>")
    (missing,) = one_mesh(path).missing
    assert "unsupported mesh format" in missing.reason
    assert "Convert it to one of dae, stl, obj" in missing.reason


def test_a_mesh_of_too_many_bytes_or_triangles_is_missing(
    stl: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(meshes, "MAX_TRIANGLES", 11)
    assert "has 12 triangles; the limit is 11" in one_mesh(stl).missing[0].reason
    with stl.open("ab") as file:
        file.truncate(meshes.MAX_BYTES + 1)
    assert "is larger than 128 MB" in one_mesh(stl).missing[0].reason


def test_shapes_beyond_the_size_of_a_robot_are_missing(
    stl: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    node = f"<visual><geometry><mesh filename='{stl}'/></geometry></visual>"
    text = f"<robot name='r'><link name='l'>{3 * node}</link></robot>"
    (shape, *_) = load(text, stl.parent).links["l"].visuals
    assert isinstance(shape.node, Mesh)
    size = shape.node.vertices.nbytes + shape.node.faces.nbytes
    monkeypatch.setattr(build, "MAX_BYTES", 2 * size)
    robot = load(text, stl.parent)
    assert len(robot.links["l"].visuals) == 2
    assert "Simplify its meshes" in robot.missing[0].reason


def test_a_picture_of_too_many_pixels_is_not_decoded_and_the_body_is_shown(tmp_path: Path) -> None:
    Image.new("1", (12000, 12000)).save(tmp_path / "p.png")
    path = tmp_path / "t.dae"
    path.write_text(tetrahedron_dae(effects=TEXTURED, image="p.png"))
    wall = f"<material name='w'><texture filename='{tmp_path}/p.png'/></material>"
    for visual in (
        f"<visual><geometry><mesh filename='{path}'/></geometry></visual>",
        f"<visual><geometry><box size='1 1 1'/></geometry>{wall}</visual>",
    ):
        robot = load(f"<robot name='r'><link name='l'>{visual}</link></robot>", tmp_path)
        assert isinstance(only_node(robot), Mesh)
        assert "has 144 megapixels; the limit is 67 megapixels" in robot.warnings[0]


def test_a_texture_outside_of_packages_and_mesh_roots_is_refused_with_the_remedy(
    tmp_path: Path,
) -> None:
    (tmp_path / "root").mkdir()
    Image.new("RGB", (3, 5)).save(tmp_path / "p.png")
    path = tmp_path / "root/t.dae"
    path.write_text(tetrahedron_dae(effects=TEXTURED, image="../p.png"))
    robot = one_mesh(path)
    assert isinstance(only_node(robot), Mesh)
    assert f"Start webviz with --mesh-root {tmp_path} to allow it." in robot.warnings[0]


@pytest.mark.parametrize("x", ["nan", "1e300"])
def test_a_mesh_with_corners_at_infinity_is_missing(tmp_path: Path, x: str) -> None:
    path = tmp_path / "a.obj"
    path.write_text(f"v {x} 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    (missing,) = one_mesh(path).missing
    assert "not finite" in missing.reason


def test_a_mesh_that_its_file_moves_to_infinity_is_missing(tmp_path: Path) -> None:
    path = tmp_path / "far.dae"
    matrix = "<matrix>1e308 0 0 0 0 1e308 0 0 0 0 1e308 0 0 0 0 1</matrix>"
    text = tetrahedron_dae(unit="1e308", up="Y_UP")
    path.write_text(text.replace('<node id="n">', f'<node id="n">{matrix}'))
    (missing,) = one_mesh(path).missing
    assert "a vertex is not finite" in missing.reason


def test_nothing_below_a_mesh_is_fetched_from_a_network(tmp_path: Path) -> None:
    document = {
        "asset": {"version": "2.0"},
        "buffers": [{"uri": "http://127.0.0.1:9/b.bin", "byteLength": 12}],
    }
    path = tmp_path / "a.gltf"
    path.write_text(json.dumps(document))
    assert len(one_mesh(path).missing) == 1


def test_a_texture_may_lie_in_a_package(tmp_path: Path) -> None:
    (tmp_path / "pkg").mkdir()
    Image.new("RGB", (3, 5)).save(tmp_path / "pkg/p.tga")
    path = tmp_path / "t.dae"
    path.write_text(tetrahedron_dae(effects=TEXTURED, image="package://pkg/p.tga"))
    geometry = f"<geometry><mesh filename='{path}'/></geometry>"
    text = f"<robot name='r'><link name='l'><visual>{geometry}</visual></link></robot>"
    robot = load_robot(text, Resolver([tmp_path], ament_prefix_path=""))
    assert b"image/png" in only_glb(robot).data
