"""Hand-worked covariances: shapes are one standard deviation, times the scale."""

import numpy as np
import pytest
from numpy.typing import NDArray

from webviz_displays.odometry import covariance
from webviz_displays.odometry.covariance import WEDGE

EYE = np.eye(3)[None]
HERE = np.zeros((1, 3))
QUARTER = np.array([[[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]])
"""90 degrees about z."""


AROUND = np.linspace(0.0, 2 * np.pi, 25)
DISC = np.array([(np.cos(a), np.sin(a), 0.0) for a in AROUND])
SPHERE = np.concatenate((np.eye(3), -np.eye(3)))


def covariance_of(*entries: tuple[int, int, float]) -> covariance.Covariances:
    matrix = np.zeros((6, 6))
    for row, column, value in entries:
        matrix[row, column] = matrix[column, row] = value
    result, ok = covariance.read(matrix.reshape(1, 36))
    assert ok.all()
    return result


def corners(shape: NDArray[np.float64], placed: covariance.Placed) -> NDArray[np.float64]:
    return placed.images(shape).reshape(-1, 3)


def extent(points: NDArray[np.float64]) -> list[float]:
    return np.abs(points).max(axis=0).round(4).tolist()


def test_a_planar_ellipse_has_half_axes_of_one_sigma() -> None:
    flat = covariance_of((0, 0, 4.0), (1, 1, 0.25), (5, 5, 0.1))
    placed = covariance.ellipses(flat, HERE, EYE, 1.0)
    assert extent(corners(DISC, placed)) == [2.0, 0.5, 0.001]
    assert extent(corners(DISC, covariance.ellipses(flat, HERE, EYE, 3.0)))[:2] == [6.0, 1.5]


def test_correlation_turns_the_ellipse() -> None:
    # Eigenvalues 3 along (1, 1) and 1 along (1, -1).
    flat = covariance_of((0, 0, 2.0), (1, 1, 2.0), (0, 1, 1.0))
    points = corners(DISC, covariance.ellipses(flat, HERE, EYE, 1.0))
    assert (points[:, :2] @ (np.sqrt(0.5), np.sqrt(0.5))).max() == pytest.approx(np.sqrt(3))
    assert (points[:, :2] @ (np.sqrt(0.5), -np.sqrt(0.5))).max() == pytest.approx(1.0)


def test_the_ellipse_turns_with_the_frame_of_the_message() -> None:
    flat = covariance_of((0, 0, 4.0), (1, 1, 0.25))
    assert extent(corners(DISC, covariance.ellipses(flat, HERE, QUARTER, 1.0)))[:2] == [0.5, 2.0]


def test_variance_of_z_makes_an_ellipsoid() -> None:
    full = covariance_of((0, 0, 1.0), (1, 1, 4.0), (2, 2, 9.0))
    assert len(covariance.ellipses(full, HERE, EYE, 1.0).centers) == 0
    points = corners(SPHERE, covariance.ellipsoids(full, HERE, EYE, 0.5))
    assert extent(points) == [0.5, 1.0, 1.5]


def test_the_yaw_wedge_is_as_wide_as_the_tangent_of_one_sigma() -> None:
    flat = covariance_of((5, 5, np.deg2rad(45.0) ** 2))
    points = corners(WEDGE, covariance.wedges(flat, HERE, EYE, 1.0, 2.0))
    np.testing.assert_allclose(points, [(0, 0, 1e-3), (2, -2, 1e-3), (2, 2, 1e-3)], atol=1e-6)
    half = corners(WEDGE, covariance.wedges(flat, HERE, EYE, 0.5, 2.0))
    assert half[2, 1] == pytest.approx(2.0 * np.tan(np.deg2rad(22.5)))


def test_the_yaw_wedge_ends_at_89_degrees() -> None:
    flat = covariance_of((5, 5, 100.0))
    points = corners(WEDGE, covariance.wedges(flat, HERE, EYE, 1.0, 1.0))
    assert points[2, 1] == pytest.approx(np.tan(np.deg2rad(89.0)), rel=1e-5)


def test_the_tip_of_x_moves_along_y_by_yaw_and_along_z_by_pitch() -> None:
    full = covariance_of((3, 3, 1.0), (4, 4, 0.1**2), (5, 5, 0.2**2))
    points = corners(DISC, covariance.tip_discs(full, HERE, EYE, 1.0, 2.0, 0))
    np.testing.assert_allclose(points[:, 0], 2.0)
    assert extent(points)[1:] == [round(2 * np.tan(0.2), 4), round(2 * np.tan(0.1), 4)]


def test_a_correlated_rotation_moves_the_tip_by_the_cross_product() -> None:
    # Yaw and pitch always equal: w = (0, s, s), so the tip of x moves along w x e = (0, s, -s).
    full = covariance_of((3, 3, 1.0), (4, 4, 0.01), (5, 5, 0.01), (4, 5, 0.01))
    points = corners(DISC, covariance.tip_discs(full, HERE, EYE, 1.0, 1.0, 0))
    np.testing.assert_allclose(points[:, 1], -points[:, 2], atol=1e-5)
    assert points[:, 1].max() == pytest.approx(np.tan(np.sqrt(0.02)) / np.sqrt(2))


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_random_small_rotations_scatter_as_the_discs_say(axis: int) -> None:
    random = np.random.default_rng(1)
    root = random.normal(size=(3, 3)) * 0.01
    matrix = np.zeros((6, 6))
    matrix[3:, 3:] = root @ root.T
    matrix[2, 2] = 1.0
    full, _ = covariance.read(matrix.reshape(1, 36))
    placed = covariance.tip_discs(full, HERE, EYE, 1.0, 1.0, axis)  # type: ignore[arg-type]
    halves = placed.frames[0][:, :2]
    moves = np.cross(random.normal(size=(200_000, 3)) @ root.T, np.eye(3)[axis])
    np.testing.assert_allclose(halves @ halves.T, np.cov(moves.T), atol=2e-6)


@pytest.mark.parametrize(
    "entry", [(0, 0, -1.0), (5, 5, -0.1), (0, 1, 5.0), (0, 0, np.nan), (3, 4, np.inf)]
)
def test_invalid_covariances_are_refused(entry: tuple[int, int, float]) -> None:
    matrix = np.diag([1.0, 1.0, 0.0, 0.0, 0.0, 1.0])
    matrix[entry[0], entry[1]] = matrix[entry[1], entry[0]] = entry[2]
    _, ok = covariance.read(np.stack((matrix.ravel(), np.zeros(36))))
    assert ok.tolist() == [False, True]


def test_eigenvalues_rounded_below_zero_are_accepted() -> None:
    third = np.full((3, 3), 1.0 / 3.0)  # singular, its eigenvalues are 1, 0 and 0 plus rounding
    matrix = np.zeros((6, 6))
    matrix[:3, :3] = third
    assert covariance.read(matrix.reshape(1, 36))[1].all()


def test_the_wedge_is_counter_clockwise_seen_from_above() -> None:
    a, b, c = WEDGE
    assert np.cross(b - a, c - a)[2] > 0


def test_each_copy_of_a_shape_has_a_place_of_its_own() -> None:
    placed = covariance.Placed(np.array([(0.0, 0, 0), (5, 0, 0)]), np.stack([np.eye(3)] * 2))
    assert placed.images(WEDGE)[1].tolist() == [[5, 0, 0], [6, -1, 0], [6, 1, 0]]
