"""Rods lead from tail to tip."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from webviz.data.rotations import matrices
from webviz_displays.shared.rods import rods

point = st.tuples(*[st.floats(-100, 100)] * 3)


@given(point, point)
def test_a_rod_leads_from_its_tail_to_its_tip(
    tail: tuple[float, float, float], tip: tuple[float, float, float]
) -> None:
    (position,), (scale,), (wxyz,) = rods([tail], [tip], 0.1)
    half = scale[2] / 2 * matrices(wxyz)[:, 2]
    assert np.linalg.norm(wxyz) == pytest.approx(1.0)
    assert position - half == pytest.approx(np.array(tail), abs=1e-3)
    assert position + half == pytest.approx(np.array(tip), abs=1e-3)
    assert scale[:2].tolist() == [0.1, 0.1]


def test_a_rod_straight_down_is_turned_by_half() -> None:
    _, _, (wxyz,) = rods([(0, 0, 1)], [(0, 0, 0)], 0.1)
    assert matrices(wxyz)[:, 2] == pytest.approx((0, 0, -1))


def test_each_rod_may_have_its_own_diameter() -> None:
    assert rods(np.zeros((2, 3)), np.ones((2, 3)), [0.1, 0.2]).scales[:, 0].tolist() == [0.1, 0.2]
    assert rods(np.zeros((0, 3)), np.zeros((0, 3)), 0.1).wxyzs.shape == (0, 4)
