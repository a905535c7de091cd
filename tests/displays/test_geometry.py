import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from webviz import Pose
from webviz_displays.shared.geometry import (
    is_drawable,
    matrices,
    multiply,
    normalized,
    origin_near,
    transformed,
    w_first,
)

seeds = st.integers(0, 2**31)


@given(seeds)
def test_rotations_agree_with_scipy(seed: int) -> None:
    a, b = map(Rotation.from_quat, np.random.default_rng(seed).normal(size=(2, 3, 4)))
    product = multiply(w_first(a.as_quat()), w_first(b.as_quat()))
    np.testing.assert_allclose(matrices(product), (a * b).as_matrix(), atol=1e-12)


def test_a_pose_turns_points_before_it_moves_them() -> None:
    quarter = np.sqrt(0.5)
    pose = Pose((10.0, 0.0, 0.0), (quarter, 0.0, 0.0, quarter))  # 90 degrees about z
    np.testing.assert_allclose(transformed(pose, [(1, 2, 3)]), [(8, 1, 3)], atol=1e-12)


def test_what_cannot_be_normalized_becomes_the_identity() -> None:
    quaternions = [(0, 0, 0, 0), (1e300, 0, 0, 0), (0, 0, 0, 1e-310), (np.nan, 0, 0, 1)]
    unit, ok = normalized([*quaternions, (np.inf, 0, 0, 0), (3, 0, 4, 0)])
    assert ok.tolist() == [False, True, True, False, False, True]
    identity = [1, 0, 0, 0]
    assert unit.tolist() == [
        identity, identity, [0, 0, 0, 1], identity, identity, [0.6, 0, 0.8, 0]
    ]  # fmt: skip


def test_points_that_no_screen_can_show_are_told() -> None:
    points = [(0, 0, 0), (np.nan, 0, 0), (0, -np.inf, 0), (0, 0, 1e300), (5e5, 4e6, 0)]
    assert is_drawable(points).tolist() == [True, False, False, False, True]


def test_the_origin_near_data_is_round_and_zero_at_home() -> None:
    assert origin_near([(400.0, -499.0, 3.0)]) == (0.0, 0.0, 0.0)
    assert origin_near([(0.0, 0.0, 0.0), (448_262.7, 5_411_932.1, 110.0)]) == (448e3, 5412e3, 0.0)


def test_empty_arrays_stay_empty() -> None:
    assert matrices(np.zeros((0, 4))).shape == (0, 3, 3)
    assert transformed(Pose(), np.zeros((0, 3))).shape == (0, 3)
    assert normalized(np.zeros((0, 4)))[0].shape == (0, 4)
