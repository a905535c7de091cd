"""Forward kinematics, compared with yourdfpy's and with sums by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
import yourdfpy
from robots import robots_folder
from trimesh.transformations import quaternion_matrix

from webviz import Pose
from webviz_urdf import Kinematics, Resolver, Robot, load_robot


def loaded(text: str) -> Robot:
    return load_robot(f"<robot name='r'>{text}</robot>", Resolver(ament_prefix_path=""))


def joint(name: str, kind: str, parent: str, child: str, inner: str = "") -> str:
    return (
        f"<joint name='{name}' type='{kind}'><origin xyz='0 0 1'/>"
        f"<parent link='{parent}'/><child link='{child}'/>{inner}</joint>"
    )


@pytest.mark.parametrize(
    "file",
    [
        "panda_description/urdf/panda.urdf",  # with a mimicking finger
        "talos_data/robots/talos_reduced.urdf",
    ],
)
def test_links_are_where_yourdfpy_places_them(file: str) -> None:
    path = robots_folder() / file
    model = yourdfpy.URDF.load(str(path), load_meshes=False, build_scene_graph=True)
    bare = load_robot(path.read_text(), Resolver(ament_prefix_path=""), collisions=False)
    kinematics = Kinematics(bare)
    values = np.random.default_rng(1).uniform(-1.5, 1.5, (3, len(kinematics.joints)))
    xyz, wxyz = kinematics.places(values)
    for case, positions in enumerate(values):
        model.update_cfg(dict(zip(kinematics.joints, positions.tolist(), strict=True)))
        for row, link in enumerate(kinematics.links):
            expected = model.get_transform(link, bare.root)
            np.testing.assert_allclose(xyz[case, row], expected[:3, 3], atol=1e-9)
            turn = quaternion_matrix(wxyz[case, row])
            np.testing.assert_allclose(turn[:3, :3], expected[:3, :3], atol=1e-9)


def test_a_joint_moves_only_its_descendants() -> None:
    links = "".join(f"<link name='{name}'/>" for name in "abcdef")
    robot = loaded(
        links
        + joint("j1", "revolute", "a", "b", "<limit lower='-1' upper='1'/>")
        + joint("j2", "fixed", "b", "c")
        + joint("j3", "prismatic", "c", "d")
        + joint("j4", "floating", "a", "e")
        + joint("j5", "fixed", "e", "f")
    )
    kinematics = Kinematics(robot)
    assert kinematics.joints == ("j1", "j3")
    assert kinematics.free == ("j4",)
    assert kinematics.moved_by(["j1"]) == {"b", "c", "d"}
    assert kinematics.moved_by(["j3"]) == {"d"}
    assert kinematics.moved_by(["j4"]) == {"e", "f"}
    assert kinematics.moved_by([]) == set()


def test_free_joints_and_the_base_take_poses() -> None:
    robot = loaded("<link name='a'/><link name='b'/>" + joint("j", "floating", "a", "b"))
    kinematics = Kinematics(robot)
    half = math.sqrt(0.5)
    base = Pose((10.0, 0.0, 0.0), (half, 0.0, 0.0, half))
    xyz, wxyz = kinematics.places(np.zeros(0), {"j": Pose((2.0, 0.0, 0.0), base.wxyz)}, base)
    np.testing.assert_allclose(xyz, [(10, 0, 0), (10, 2, 1)], atol=1e-12)
    np.testing.assert_allclose(wxyz[1], (0.0, 0.0, 0.0, 1.0), atol=1e-12)


def test_mimicking_joints_follow_through_others_and_loops_stay() -> None:
    links = "".join(f"<link name='{name}'/>" for name in "abcdef")
    slide = "<axis xyz='1 0 0'/>"
    robot = loaded(
        links
        + joint("j1", "prismatic", "a", "b", slide)
        + joint(
            "j2", "prismatic", "a", "c", slide + "<mimic joint='j1' multiplier='2' offset='1'/>"
        )
        + joint("j3", "prismatic", "a", "d", slide + "<mimic joint='j2' multiplier='-1'/>")
        + joint("j4", "prismatic", "a", "e", slide + "<mimic joint='j5'/>")
        + joint("j5", "prismatic", "a", "f", slide + "<mimic joint='j4'/>")
    )
    kinematics = Kinematics(robot)
    assert kinematics.joints == ("j1", "j4", "j5")
    xyz, _ = kinematics.places(np.array([0.5, 3.0, 4.0]))
    np.testing.assert_allclose(xyz[:, 0], [0.0, 0.5, 2.0, -2.0, 3.0, 4.0])
    assert kinematics.moved_by(["j1"]) == {"b", "c", "d"}


def test_a_chain_of_thousands_of_links_takes_few_rounds() -> None:
    count = 3000
    links = "".join(f"<link name='l{i}'/>" for i in range(count))
    joints = "".join(joint(f"j{i}", "continuous", f"l{i}", f"l{i + 1}") for i in range(count - 1))
    kinematics = Kinematics(loaded(links + joints))
    xyz, _ = kinematics.places(np.zeros(count - 1))
    np.testing.assert_allclose(xyz[:, 2], np.arange(count))
    assert len(kinematics.moved_by(["j0"])) == count - 1
