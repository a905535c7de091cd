"""Colours by urdfdom's and RViz's rules."""

from __future__ import annotations

from pathlib import Path

from PIL import Image
from small_robots import load, only_mesh, tetrahedron_dae

from webviz.api.nodes import Glb, Mesh

BOX = "<geometry><box size='1 1 1'/></geometry>"
RED, GREEN, BLUE = (255, 0, 0), (0, 255, 0), (0, 0, 255)


def visual(material: str) -> str:
    return f"<visual>{BOX}{material}</visual>"


def material(name: str, rgba: str = "") -> str:
    color = f"<color rgba='{rgba}'/>" if rgba else ""
    return f"<material name='{name}'>{color}</material>"


def links(*contents: str, before: str = "", after: str = "") -> str:
    """A robot whose links hang in a row."""
    text = "".join(f"<link name='l{i}'>{content}</link>" for i, content in enumerate(contents))
    text += "".join(
        f"<joint name='j{i}' type='fixed'><parent link='l{i - 1}'/><child link='l{i}'/></joint>"
        for i in range(1, len(contents))
    )
    return f"<robot name='r'>{before}{text}{after}</robot>"


def colors(text: str) -> list[tuple[int, int, int]]:
    """Return the colours of all visuals of a description in order."""
    nodes = [shape.node for link in load(text).links.values() for shape in link.visuals]
    return [node.color for node in nodes if isinstance(node, Mesh)]


def test_a_visual_without_a_material_is_shaded_red() -> None:
    assert colors(links(visual(""))) == [RED]


def test_a_material_that_is_defined_nowhere_is_red_and_named() -> None:
    text = links(visual(material("ghost")))
    assert colors(text) == [RED]
    assert "'ghost' of link 'l0'" in load(text).warnings[0]


def test_no_default_colour_is_announced_for_a_mesh_that_brings_its_own(tmp_path: Path) -> None:
    path = tmp_path / "t.dae"
    path.write_text(tetrahedron_dae())
    mesh = f"<geometry><mesh filename='{path}'/></geometry><material name='gone'/>"
    robot = load(links(f"<visual>{mesh}</visual>"), tmp_path)
    assert only_mesh(robot).color == GREEN
    assert robot.warnings == ()
    path.write_text(tetrahedron_dae(bound=False))
    assert "'gone'" in load(links(f"<visual>{mesh}</visual>"), tmp_path).warnings[0]


def test_a_material_of_the_robot_is_used_by_name_before_and_after_it_is_defined() -> None:
    blue = material("m", "0 0 1 1")
    assert colors(links(visual(material("m")), before=blue)) == [BLUE]
    assert colors(links(visual(material("m")), after=blue)) == [BLUE]


def test_a_material_defined_inside_a_link_is_used_by_name_in_another() -> None:
    text = links(visual(material("m", "0 1 0 1")), visual(material("m")))
    assert colors(text) == [GREEN, GREEN]


def test_the_first_definition_of_a_name_counts_and_the_conflict_is_named() -> None:
    text = links(visual(material("m", "0 1 0 1")), visual(material("m", "0 0 1 1")))
    assert colors(text) == [GREEN, GREEN]
    assert "'m' is redefined" in load(text).warnings[0]


def test_a_material_of_the_robot_wins_over_one_of_a_link() -> None:
    text = links(visual(material("m", "0 1 0 1")), before=material("m", "0 0 1 1"))
    assert colors(text) == [BLUE]


def test_materials_without_a_name_are_each_their_own() -> None:
    text = links(
        visual(material("", "0 1 0 1")), visual("<material><color rgba='0 0 1 1'/></material>")
    )
    assert colors(text) == [GREEN, BLUE]
    assert not load(text).warnings


def test_the_alpha_of_a_material_is_the_opacity() -> None:
    assert only_mesh(load(links(visual(material("m", "0 1 0 0.25"))))).opacity == 0.25


def test_colours_beyond_the_range_are_clamped() -> None:
    assert colors(links(visual(material("m", "-1 2 0 1")))) == [GREEN]


def test_collisions_wear_the_material_of_the_first_visual() -> None:
    text = links(visual(material("m", "0 1 0 1")) + f"<collision>{BOX}</collision>")
    (shape,) = load(text).links["l0"].collisions
    assert isinstance(shape.node, Mesh)
    assert shape.node.color == GREEN


def test_an_empty_texture_element_leaves_the_colour() -> None:
    text = "<material name='m'><color rgba='0 1 0 1'/><texture/></material>"
    assert colors(links(visual(text))) == [GREEN]
    text = "<material name='m'><color rgba='0 1 0 1'/><texture filename=''/></material>"
    assert colors(links(visual(text))) == [GREEN]


def test_a_texture_covers_a_box_and_colours_a_sphere(tmp_path: Path) -> None:
    Image.new("RGB", (4, 4), BLUE).save(tmp_path / "blue.png")
    texture = f"<material name='m'><texture filename='file://{tmp_path}/blue.png'/></material>"
    ball = f"<visual><geometry><sphere radius='1'/></geometry>{texture}</visual>"
    box, sphere = load(links(visual(texture) + ball), tmp_path).links["l0"].visuals
    assert isinstance(box.node, Glb)
    assert b"image/png" in box.node.data
    assert isinstance(sphere.node, Mesh)
    assert sphere.node.color == BLUE


def test_a_texture_that_is_not_there_or_no_picture_leaves_the_colour_and_is_named(
    tmp_path: Path,
) -> None:
    (tmp_path / "bad.png").write_text("bad")
    for name in ("gone.png", "bad.png"):
        text = (
            f"<material name='m'><color rgba='0 1 0 1'/><texture filename='{tmp_path}/{name}'/>"
            "</material>"
        )
        robot = load(links(visual(text)), tmp_path)
        assert only_mesh(robot).color == GREEN
        assert name in robot.warnings[0]
