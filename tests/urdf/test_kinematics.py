"""Where links are for given joint positions."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from webviz import Pose, compose
from webviz_urdf import Resolver, Robot, load_robot

angle = st.floats(-10, 10)


def chain(*joints: str) -> Robot:
    """Links l0, l1, ... joined by j1, j2, ..., each 1 m above the last."""
    text = "<link name='l0'/>"
    for i, joint in enumerate(joints, start=1):
        kind, _, extra = joint.partition(" ")
        text += (
            f"<link name='l{i}'/><joint name='j{i}' type='{kind}'><origin xyz='0 0 1'/>"
            f"<parent link='l{i - 1}'/><child link='l{i}'/>{extra}</joint>"
        )
    return load_robot(f"<robot name='r'>{text}</robot>", Resolver(ament_prefix_path=""))


def matrix(pose: Pose) -> np.ndarray:
    w, x, y, z = pose.wxyz
    result = np.eye(4)
    result[:3, :3] = Rotation.from_quat((x, y, z, w)).as_matrix()
    result[:3, 3] = pose.position
    return result


@given(st.tuples(angle, angle, angle))
def test_rpy_turns_about_fixed_axes_x_then_y_then_z(rpy):
    text = "<origin rpy='{} {} {}'/>".format(*rpy)
    robot = load_robot(
        f"<robot name='r'><link name='a'/><link name='b'/><joint name='j' type='fixed'>{text}"
        "<parent link='a'/><child link='b'/></joint></robot>",
        Resolver(ament_prefix_path=""),
    )
    expected = Rotation.from_euler("xyz", rpy).as_matrix()
    np.testing.assert_allclose(matrix(robot.fk()["b"])[:3, :3], expected, atol=1e-7)


@given(st.tuples(*[angle] * 6), st.tuples(*[angle] * 6))
def test_composing_poses_is_multiplying_their_matrices(a, b):
    poses = []
    for numbers in (a, b):
        x, y, z, w = Rotation.from_euler("xyz", numbers[3:]).as_quat().tolist()
        poses.append(Pose(numbers[:3], (w, x, y, z)))
    composed = matrix(compose(*poses))
    np.testing.assert_allclose(composed, matrix(poses[0]) @ matrix(poses[1]), atol=1e-9)


def test_joints_move_along_and_about_their_axes():
    robot = chain("revolute <axis xyz='0 2 0'/>", "prismatic <axis xyz='0 0 1'/>")
    poses = robot.fk({"j1": math.pi / 2, "j2": 0.5})
    assert poses["l1"].position == pytest.approx((0, 0, 1))
    assert poses["l2"].position == pytest.approx((1.5, 0, 1))


def test_joints_left_out_stand_at_zero_and_unknown_names_are_ignored():
    robot = chain("continuous", "fixed", "floating", "planar")
    assert robot.fk({"nobody": 1.0})["l4"].position == (0.0, 0.0, 4.0)


def test_an_axis_left_out_is_x_and_a_zero_axis_does_not_move():
    assert chain("revolute").joints["j1"].axis == (1.0, 0.0, 0.0)
    robot = chain("revolute <axis xyz='0 0 0'/>", "fixed")
    assert robot.fk({"j1": 1.0})["l2"].position == (0.0, 0.0, 2.0)


def test_a_chain_of_mimics_follows_its_leader_and_ignores_positions_of_its_own():
    robot = chain(
        "prismatic <axis xyz='1 0 0'/>",
        "prismatic <axis xyz='1 0 0'/><mimic joint='j1' multiplier='2' offset='1'/>",
        "prismatic <axis xyz='1 0 0'/><mimic joint='j2' multiplier='-3'/>",
    )
    x = [robot.fk({"j1": 0.5, "j2": 99.0, "j3": 99.0})[f"l{i}"].position[0] for i in range(4)]
    # 0.5, then 2 * 0.5 + 1 = 2, then -3 * 2 = -6
    assert x == pytest.approx([0, 0.5, 2.5, -3.5])


@pytest.mark.parametrize("leader", ["j1", "j2", "gone"])
def test_a_mimic_of_nothing_or_in_a_circle_becomes_a_free_joint_with_a_warning(leader):
    axis = "<axis xyz='1 0 0'/>"
    robot = chain(
        f"prismatic {axis}<mimic joint='{leader}'/>", f"prismatic {axis}<mimic joint='j1'/>"
    )
    assert len(robot.warnings) == 1
    assert "drawn as a free joint" in robot.warnings[0]
    assert robot.fk({"j1": 1.0, "j2": 1.0})["l2"].position == pytest.approx((2, 0, 2))


def test_a_chain_of_two_thousand_links_is_walked():
    robot = chain(*["fixed"] * 2000)
    assert robot.fk()["l2000"].position == (0.0, 0.0, 2000.0)
