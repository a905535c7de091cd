"""Rotations are what scipy says."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from webviz.data.rotations import (
    Quaternion,
    angle_between,
    conjugate,
    from_axis_angle,
    from_matrices,
    from_rpy,
    matrices,
    multiply,
    multiply_many,
    normalized,
    to_rpy,
    w_first,
    w_last,
)

seeds = st.integers(0, 2**31)
angles = st.floats(-10, 10)


def some(seed: int, count: int = 5) -> Rotation:
    return Rotation.from_quat(np.random.default_rng(seed).normal(size=(count, 4)))


def scipy_of(wxyz: Quaternion) -> Rotation:
    return Rotation.from_quat(w_last(wxyz))


@given(seeds)
def test_matrices_of_products_are_products_of_matrices(seed: int) -> None:
    a, b = some(seed), some(seed + 1)
    product = multiply_many(w_first(a.as_quat()), w_first(b.as_quat()))
    np.testing.assert_allclose(matrices(product), (a * b).as_matrix(), atol=1e-12)
    first = multiply(*(tuple(w_first(r.as_quat()[0]).tolist()) for r in (a, b)))
    np.testing.assert_allclose(first, product[0], atol=1e-12)


@given(seeds)
def test_one_rotation_follows_many(seed: int) -> None:
    one, many = some(seed, 1)[0], some(seed + 1)
    product = multiply_many(w_first(one.as_quat()), w_first(many.as_quat()))
    np.testing.assert_allclose(matrices(product), (one * many).as_matrix(), atol=1e-12)


@given(seeds)
def test_the_conjugate_is_the_inverse(seed: int) -> None:
    inverse = matrices(conjugate(w_first(some(seed).as_quat())))
    np.testing.assert_allclose(inverse, some(seed).inv().as_matrix(), atol=1e-12)


@given(seeds)
def test_quaternions_come_back_from_matrices(seed: int) -> None:
    turns = some(seed)
    half = Rotation.from_rotvec(np.pi * np.eye(3))  # w is zero
    for rotations in (turns, half):
        back = matrices(from_matrices(rotations.as_matrix()))
        np.testing.assert_allclose(back, rotations.as_matrix(), atol=1e-12)


@given(st.tuples(angles, angles, angles))
def test_rpy_turns_about_the_fixed_axes_x_then_y_then_z(rpy: tuple[float, float, float]) -> None:
    expected = Rotation.from_euler("xyz", rpy)
    assert (scipy_of(from_rpy(*rpy)) * expected.inv()).magnitude() < 1e-9
    assume(abs(math.cos(rpy[1])) > 1e-3)  # else roll and yaw are about one axis
    back = scipy_of(from_rpy(*to_rpy(from_rpy(*rpy))))
    assert (back * expected.inv()).magnitude() < 1e-6


@given(seeds, angles)
def test_a_rotation_about_an_axis_is_its_rotation_vector(seed: int, angle: float) -> None:
    vector = np.random.default_rng(seed).normal(size=3)
    x, y, z = (vector / np.linalg.norm(vector)).tolist()
    expected = Rotation.from_rotvec(angle * np.array((x, y, z)))
    turn = scipy_of(from_axis_angle((x, y, z), angle))
    assert (turn * expected.inv()).magnitude() < 1e-9


def test_a_zero_axis_is_the_identity() -> None:
    assert from_axis_angle((0.0, 0.0, 0.0), 1.0) == (1.0, 0.0, 0.0, 0.0)


@given(seeds, st.floats(0.1, 10))
def test_the_angle_between_rotations_does_not_hang_on_their_lengths(
    seed: int, length: float
) -> None:
    a, b = some(seed, 2)
    w, x, y, z = w_first(a.as_quat()).tolist()
    scaled = (length * w, length * x, length * y, length * z)
    angle = angle_between(scaled, tuple(w_first(b.as_quat()).tolist()))
    assert angle == pytest.approx((b.inv() * a).magnitude(), abs=1e-9)


def test_quaternions_without_a_direction_become_the_identity() -> None:
    quaternions = [(0, 0, 0, 0), (1e300, 0, 0, 0), (0, 0, 0, 1e-310), (np.nan, 0, 0, 1)]
    unit, ok = normalized([*quaternions, (np.inf, 0, 0, 0), (3, 0, 4, 0)])
    assert ok.tolist() == [False, True, True, False, False, True]
    identity = [1, 0, 0, 0]
    assert unit.tolist() == [
        identity, identity, [0, 0, 0, 1], identity, identity, [0.6, 0, 0.8, 0]
    ]  # fmt: skip


def test_empty_arrays_stay_empty() -> None:
    assert matrices(np.zeros((0, 4))).shape == (0, 3, 3)
    assert multiply_many((1, 0, 0, 0), np.zeros((0, 4))).shape == (0, 4)
    assert normalized(np.zeros((0, 4)))[0].shape == (0, 4)
