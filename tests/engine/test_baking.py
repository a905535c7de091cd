"""Coordinates with a pose worked in are where a browser would have put them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from webviz.api.nodes import Arrows, Axes, Instances, Labels, Lines, Mesh, Points, Pose
from webviz.engine.pipeline.baking import REACH_M, baked, can_bake, origin_near

coordinate = st.floats(-REACH_M, REACH_M, width=32)
position = st.tuples(coordinate, coordinate, coordinate)
quaternion = st.tuples(*[st.floats(-1, 1)] * 4).filter(lambda q: np.linalg.norm(q) > 0.1)


@st.composite
def poses(draw: st.DrawFn) -> Pose:
    w, x, y, z = np.array(q := draw(quaternion)) / np.linalg.norm(q)
    return Pose(draw(position), (float(w), float(x), float(y), float(z)))


@given(poses(), st.lists(position, min_size=2, max_size=4))
def test_points_lines_arrows_and_labels(pose: Pose, corners: list) -> None:
    xyz = np.array(corners, np.float32)
    segments = np.stack([xyz[:-1], xyz[1:]], axis=1)
    rotation = Rotation.from_quat(np.roll(pose.wxyz, -1))
    expected = rotation.apply(xyz.astype(float)) + pose.position
    origin = (500.0, -1000.0, 0.0)
    plane = 0.6, 0.0, -0.8, 3.0
    points = baked(Points(xyz, (1, 2, 3), 0.1, plane=plane), pose, origin)
    lines = baked(Lines(segments, (1, 2, 3)), pose, origin)
    arrows = baked(Arrows(segments, (1, 2, 3), 0.1, 0.2, 0.3), pose, origin)
    labels = baked(Labels(xyz, ("a",) * len(xyz), 0.1), pose, origin)
    assert isinstance(points, Points)
    assert isinstance(lines, Lines)
    assert isinstance(arrows, Arrows)
    assert isinstance(labels, Labels)
    np.testing.assert_allclose(points.xyz + np.array(origin), expected, atol=2e-3)
    a, b, c, d = points.plane or plane
    before = xyz @ plane[:3] + plane[3]
    np.testing.assert_allclose(points.xyz @ (a, b, c) + d, before, atol=5e-3)
    np.testing.assert_array_equal(labels.positions, points.xyz)
    np.testing.assert_array_equal(lines.segments[:, 0], points.xyz[:-1])
    np.testing.assert_array_equal(arrows.segments[:, 1], points.xyz[1:])


@given(poses(), poses())
def test_axes_are_turned(pose: Pose, inner: Pose) -> None:
    node = Axes(
        np.array([inner.position], np.float32), np.array([inner.wxyz], np.float32), 1.0, 0.1
    )
    result = baked(node, pose, (0.0, 0.0, 0.0))
    assert isinstance(result, Axes)
    outer = Rotation.from_quat(np.roll(pose.wxyz, -1))
    expected = outer * Rotation.from_quat(np.roll(inner.wxyz, -1))
    rotation = Rotation.from_quat(np.roll(result.wxyzs[0], -1))
    assert (expected.inv() * rotation).magnitude() < 1e-5


@given(poses(), poses())
def test_instances_are_moved_and_turned(pose: Pose, inner: Pose) -> None:
    place, size = np.array([inner.position], np.float32), np.ones((1, 3), np.float32)
    turn = np.array([inner.wxyz], np.float32)
    outer = Rotation.from_quat(np.roll(pose.wxyz, -1))
    for wxyzs in (turn, None):
        result = baked(Instances(place, size, (1, 2, 3), wxyzs=wxyzs), pose, (0.0, 0.0, 0.0))
        assert isinstance(result, Instances)
        own = Rotation.identity() if wxyzs is None else Rotation.from_quat(np.roll(inner.wxyz, -1))
        turned = Rotation.identity()
        if result.wxyzs is not None:  # at the identity they stay as they are: not turned
            turned = Rotation.from_quat(np.roll(result.wxyzs[0], -1))
        assert ((outer * own).inv() * turned).magnitude() < 1e-5
        expected = outer.apply(place.astype(float)) + pose.position
        np.testing.assert_allclose(result.positions, expected, atol=2e-3)


def test_the_identity_keeps_the_very_arrays() -> None:
    node = Points(np.zeros((3, 3), np.float32), (1, 2, 3), 0.1)
    assert baked(node, Pose(), (0.0, 0.0, 0.0)) is node


@pytest.mark.parametrize("length", [0.0, 1e-200])
def test_a_quaternion_without_length_turns_nothing(length: float) -> None:
    node = Points(np.ones((2, 3), np.float32), (1, 2, 3), 0.1)
    result = baked(node, Pose((1.0, 2.0, 3.0), (length, 0.0, 0.0, 0.0)), (0.0, 0.0, 0.0))
    assert isinstance(result, Points)
    np.testing.assert_array_equal(result.xyz, [(2, 3, 4)] * 2)


def test_far_out_the_origin_comes_along_so_that_millimetres_survive() -> None:
    far = (500_000.0, 4_600_000.0, 0.0)
    origin = origin_near(far, (0.0, 0.0, 0.0))
    xyz = np.array([[0.001, 0.002, 0.003]], np.float32)
    node = baked(Points(xyz, (1, 2, 3), 0.1), Pose(far), origin)
    assert isinstance(node, Points)
    positions = node.xyz.astype(float) + origin - np.array(far)
    np.testing.assert_allclose(positions, xyz, atol=1e-4)


def test_the_origin_stays_while_data_is_near() -> None:
    origin = origin_near((1400.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    assert origin == (1000.0, 0.0, 0.0)
    assert origin_near((600.0, 0.0, 0.0), origin) == origin
    assert origin_near((0.0, 0.0, 900.0), origin) == origin


def test_meshes_have_a_pose_instead() -> None:
    mesh = Mesh(np.zeros((3, 3), np.float32), np.zeros((1, 3), np.uint32), (1, 2, 3))
    assert not can_bake(mesh)
    with pytest.raises(TypeError):
        baked(mesh, Pose((1.0, 0.0, 0.0)), (0.0, 0.0, 0.0))
