"""Joints of a description."""

from __future__ import annotations

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
def test_rpy_turns_about_fixed_axes_x_then_y_then_z(rpy: tuple[float, float, float]) -> None:
    text = "<origin rpy='{} {} {}'/>".format(*rpy)
    robot = load_robot(
        f"<robot name='r'><link name='a'/><link name='b'/><joint name='j' type='fixed'>{text}"
        "<parent link='a'/><child link='b'/></joint></robot>",
        Resolver(ament_prefix_path=""),
    )
    expected = Rotation.from_euler("xyz", rpy).as_matrix()
    np.testing.assert_allclose(matrix(robot.joints["j"].origin)[:3, :3], expected, atol=1e-7)


@given(st.tuples(*[angle] * 6), st.tuples(*[angle] * 6))
def test_composing_poses_is_multiplying_their_matrices(
    a: tuple[float, ...], b: tuple[float, ...]
) -> None:
    poses = []
    for numbers in (a, b):
        x, y, z, w = Rotation.from_euler("xyz", numbers[3:]).as_quat().tolist()
        poses.append(Pose((numbers[0], numbers[1], numbers[2]), (w, x, y, z)))
    composed = matrix(compose(*poses))
    np.testing.assert_allclose(composed, matrix(poses[0]) @ matrix(poses[1]), atol=1e-9)


@pytest.mark.parametrize(
    ("element", "axis"),
    [("", (1, 0, 0)), ("<axis xyz='0 2 0'/>", (0, 1, 0)), ("<axis xyz='0 0 0'/>", (0, 0, 0))],
)
def test_an_axis_is_x_by_default_has_length_one_and_may_be_zero(
    element: str, axis: tuple[int, int, int]
) -> None:
    assert chain(f"revolute {element}").joints["j1"].axis == axis


@pytest.mark.parametrize(
    ("leader", "warnings"),
    [
        ("j3", []),
        ("gone", ["Joint 'j1' mimics 'gone', which is not a joint."]),
        ("j1", ["Joint 'j1' mimics itself, directly or through other joints."]),
        ("j2", [f"Joint 'j{i}' mimics itself, directly or through other joints." for i in (1, 2)]),
    ],
)
def test_a_mimic_of_no_joint_or_in_a_circle_is_a_warning(leader: str, warnings: list[str]) -> None:
    robot = chain(
        f"prismatic <mimic joint='{leader}'/>", "prismatic <mimic joint='j1'/>", "prismatic"
    )
    assert list(robot.warnings) == warnings


def test_a_chain_of_two_thousand_links_is_read() -> None:
    assert len(chain(*["fixed"] * 2000).links) == 2001
