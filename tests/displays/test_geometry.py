import numpy as np

from webviz import Pose
from webviz_displays.shared.geometry import (
    is_drawable,
    origin_near,
    transformed,
)


def test_a_pose_turns_points_before_it_moves_them() -> None:
    quarter = np.sqrt(0.5)
    pose = Pose((10.0, 0.0, 0.0), (quarter, 0.0, 0.0, quarter))  # 90 degrees about z
    np.testing.assert_allclose(transformed(pose, [(1, 2, 3)]), [(8, 1, 3)], atol=1e-12)


def test_points_out_of_reach_are_not_drawable() -> None:
    points = [(0, 0, 0), (np.nan, 0, 0), (0, -np.inf, 0), (0, 0, 1e300), (5e5, 4e6, 0)]
    assert is_drawable(points).tolist() == [True, False, False, False, True]


def test_the_origin_near_data_is_round_and_zero_at_home() -> None:
    assert origin_near([(400.0, -499.0, 3.0)]) == (0.0, 0.0, 0.0)
    assert origin_near([(0.0, 0.0, 0.0), (448_262.7, 5_411_932.1, 110.0)]) == (448e3, 5412e3, 0.0)


def test_transforming_no_points_gives_none() -> None:
    assert transformed(Pose(), np.zeros((0, 3))).shape == (0, 3)
