"""Drawn parts of a robot and their appearance, by the user's choices."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from msgspec.structs import replace

from webviz import Arrows, Axes, Glb
from webviz_displays.robot_model.parts import (
    GREY,
    Choices,
    JointSettings,
    LinkSettings,
    Paint,
    parts_of,
)
from webviz_urdf import Resolver, glb_with, load_robot

ROBOT = load_robot(
    """
<robot name="arm">
  <link name="base">
    <visual><geometry><box size="1 1 1"/></geometry></visual>
    <collision><geometry><sphere radius="2"/></geometry></collision>
    <inertial><mass value="6"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <link name="tool">
    <visual name="grip"><geometry><box size="1 1 1"/></geometry></visual>
  </link>
  <link name="tip"/>
  <joint name="wrist" type="continuous">
    <origin xyz="0 0 3"/><parent link="base"/><child link="tool"/><axis xyz="0 2 0"/>
  </joint>
  <joint name="glue" type="fixed"><parent link="tool"/><child link="tip"/></joint>
</robot>
""",
    Resolver(),
)
PLAIN = Choices(
    visual=True,
    collision=False,
    mass=False,
    inertia=False,
    alpha=1.0,
    links={},
    joints={},
    all_links=True,
)


def nodes(**choices: Any) -> dict[str, Any]:
    """The node of each part by key, of plain choices but for these."""
    return {p.key: p.node for p in parts_of(ROBOT, ROBOT, replace(PLAIN, **choices), Paint())}


@pytest.fixture
def glb(tmp_path: Path) -> Glb:
    """A model of two materials."""
    (tmp_path / "two.obj").write_text(
        "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
        "usemtl red\nf 1 2 3\nusemtl green\nf 1 2 4\n"
    )
    (tmp_path / "two.mtl").write_text("newmtl red\nKd 1 0 0\nnewmtl green\nKd 0 1 0\n")
    robot = load_robot(
        "<robot name='m'><link name='base'><visual><geometry><mesh filename='two.obj'/></geometry>"
        "</visual></link></robot>",
        Resolver([tmp_path], base=tmp_path),
    )
    (shape,) = robot.links["base"].visuals
    assert isinstance(shape.node, Glb)
    return shape.node


def test_visual_and_collision_shapes_have_their_switches() -> None:
    visual, collision = {"base visual visual_0", "tool visual grip"}, {"base collision collision_0"}
    assert set(nodes()) == visual
    assert set(nodes(collision=True)) == visual | collision
    assert set(nodes(visual=False, collision=True)) == collision


def test_alpha_of_robot_and_link_multiply() -> None:
    half = nodes(alpha=0.5, links={"tool": LinkSettings(alpha=0.4)})
    assert half["tool visual grip"].opacity == pytest.approx(0.2)
    assert half["base visual visual_0"].opacity == pytest.approx(0.5)


def test_transparent_parts_are_not_drawn() -> None:
    assert nodes(alpha=0.0) == {}
    assert set(nodes(links={"base": LinkSettings(alpha=0.0)})) == {"tool visual grip"}


def test_a_link_goes_by_its_own_switch_if_it_has_one() -> None:
    assert set(nodes(links={"tool": LinkSettings(enabled=False)})) == {"base visual visual_0"}
    assert nodes(all_links=False) == {}
    assert set(nodes(all_links=False, links={"tool": LinkSettings()})) == {"tool visual grip"}


def test_a_link_shows_its_axes_when_enabled() -> None:
    axes = nodes(links={"tool": LinkSettings(show_axes=True)})["tool axes"]
    assert isinstance(axes, Axes)
    assert (axes.length, axes.radius) == (0.1, 0.005)


def test_a_joint_shows_its_axes_and_its_axis_in_the_frame_of_its_parent() -> None:
    settings = {"wrist": JointSettings(show_axes=True, show_joint_axis=True)}
    choices = replace(PLAIN, visual=False, joints=settings)
    parts = {part.key: part for part in parts_of(ROBOT, None, choices, Paint())}
    assert set(parts) == {"wrist joint axes", "wrist joint axis"}
    assert {part.link for part in parts.values()} == {"base"}
    assert {part.pose.position for part in parts.values()} == {(0.0, 0.0, 3.0)}
    arrow = parts["wrist joint axis"].node
    assert isinstance(arrow, Arrows)
    assert arrow.segments.tolist() == [[[0, 0, 0], [0, pytest.approx(0.2), 0]]]
    assert arrow.colors == (0, 204, 0)


def test_fixed_and_missing_joints_show_no_axis() -> None:
    both = JointSettings(show_joint_axis=True)
    assert nodes(visual=False, joints={"glue": both, "nonsense": both}) == {}


def test_a_mass_is_drawn_as_a_ball_of_lead() -> None:
    ball = nodes(visual=False, mass=True)["base mass"]
    # 6 kg at 11340 kg/m3: the cube root of 3 * 6 / (4 pi 11340) is 0.0502 m.
    assert np.linalg.norm(ball.vertices, axis=1).max() == pytest.approx(0.0502, abs=1e-4)


def test_an_inertia_is_drawn_as_its_box() -> None:
    box = nodes(visual=False, inertia=True)["base inertia"]
    assert np.ptp(box.vertices, axis=0) == pytest.approx([1.0, 1.0, 1.0])


def test_an_opaque_part_is_the_node_as_it_was_loaded() -> None:
    assert nodes(alpha=0.9999)["tool visual grip"] is ROBOT.links["tool"].visuals[0].node


def test_a_model_with_materials_of_its_own_is_painted_too(glb: Glb) -> None:
    paint = Paint()
    assert paint(glb, 0.5) == Glb(glb_with(glb.data, 0.5))
    assert paint(glb, color=GREY) == Glb(glb_with(glb.data, 1.0, GREY))


def test_paint_is_mixed_once_and_dropped_when_unused(glb: Glb) -> None:
    paint = Paint()
    first = paint(glb, 0.5)
    paint.begin()
    assert paint(glb, 0.5) is first
    paint.begin()
    paint.begin()
    assert paint(glb, 0.5) is not first
