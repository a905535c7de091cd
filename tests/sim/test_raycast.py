import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.typing import ArrayLike, NDArray

from webviz_sim.lidar import cast_rays


def cast(
    occupied: ArrayLike, x: float, y: float, angles: ArrayLike, reach: float = 1000.0
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    angles = np.atleast_1d(np.asarray(angles, dtype=float))
    starts = np.full(len(angles), float(x)), np.full(len(angles), float(y))
    return cast_rays(np.asarray(occupied, dtype=bool), *starts, angles, reach)


def brute_force(occupied: ArrayLike, x: float, y: float, angle: float) -> float:
    """Intersects a ray with each occupied cell as a box (the slab method); the nearest wins."""
    nearest = math.inf
    direction = np.array([math.cos(angle), math.sin(angle)])
    for row, column in np.argwhere(occupied):
        with np.errstate(divide="ignore", over="ignore"):
            low = (np.array([column, row]) - (x, y)) / direction
            high = (np.array([column + 1, row + 1]) - (x, y)) / direction
        entry, leave = np.minimum(low, high).max(), np.maximum(low, high).min()
        if leave > max(entry, 0.0):
            nearest = min(nearest, max(entry, 0.0))
    return nearest


def passes_a_corner(x: float, y: float, angle: float, size: int) -> bool:
    """Return whether a ray passes so close to a corner that rounding decides the cells it meets."""
    corners = np.stack(np.meshgrid(np.arange(size + 1), np.arange(size + 1)), -1).reshape(-1, 2)
    across = np.array([-math.sin(angle), math.cos(angle)])
    return bool((np.abs((corners - (x, y)) @ across) < 1e-9).any())


def test_a_ray_along_an_axis_stops_at_the_face_of_the_cell() -> None:
    occupied = np.zeros((5, 9))
    occupied[2, 7] = occupied[2, 0] = occupied[4, 3] = occupied[0, 3] = 1
    angles = [0.0, math.pi / 2, math.pi, -math.pi / 2]
    distances, incidence = cast(occupied, 3.25, 2.5, angles)
    assert np.allclose(distances, [3.75, 1.5, 2.25, 1.5])
    assert np.allclose(incidence, 1.0)


def test_a_slanting_ray_stops_below_cell_size_exactly() -> None:
    occupied = np.zeros((4, 4))
    occupied[:, 3] = 1
    distances, incidence = cast(occupied, 0.5, 0.5, math.radians(30))
    assert distances[0] == pytest.approx(2.5 / math.cos(math.radians(30)))
    assert incidence[0] == pytest.approx(math.cos(math.radians(30)))


def test_nothing_is_hit_beyond_reach_or_outside_the_grid() -> None:
    occupied = np.zeros((3, 200))
    occupied[1, 150] = 1
    assert cast(occupied, 0.5, 1.5, 0.0, reach=149.4)[0] == np.inf
    assert cast(occupied, 0.5, 1.5, 0.0, reach=149.6)[0] == pytest.approx(149.5)
    assert cast(occupied, 0.5, 1.5, math.pi)[0] == np.inf


def test_a_ray_from_outside_sees_into_the_grid() -> None:
    occupied = np.zeros((3, 3))
    occupied[1, 1] = 1
    assert cast(occupied, -100.0, 1.5, 0.0)[0] == pytest.approx(101.0)


def test_a_ray_that_starts_in_a_wall_has_no_length() -> None:
    distances, _ = cast(np.ones((3, 3)), 1.5, 1.5, np.linspace(-3, 3, 7))
    assert (distances == 0).all()


def test_no_rays_give_no_distances() -> None:
    distances, incidence = cast(np.ones((3, 3)), 1.5, 1.5, [])
    assert distances.shape == incidence.shape == (0,)


SIZE = 7


@settings(deadline=None)
@given(
    st.integers(0, 2**32 - 1),
    st.floats(0, SIZE),
    st.floats(0, SIZE),
    st.floats(-math.pi, math.pi),
    st.sampled_from([0.05, 0.2, 0.5]),
)
def test_rays_agree_with_intersecting_every_cell(
    seed: int, x: float, y: float, angle: float, density: float
) -> None:
    assume(not passes_a_corner(x, y, angle, SIZE))
    assume(min(abs(x - round(x)), abs(y - round(y))) > 1e-9)
    occupied = np.random.default_rng(seed).random((SIZE, SIZE)) < density
    distances, _ = cast(occupied, x, y, angle)
    assert distances[0] == pytest.approx(brute_force(occupied, x, y, angle), abs=1e-9)


def test_many_rays_at_once_agree_with_each_alone() -> None:
    random = np.random.default_rng(3)
    occupied = random.random((120, 90)) < 0.002
    x, y = random.uniform(0, 90, 500), random.uniform(0, 120, 500)
    angles = random.uniform(-math.pi, math.pi, 500)
    distances, _ = cast_rays(occupied, x, y, angles, 1000.0)
    expected = [brute_force(occupied, *ray) for ray in zip(x, y, angles, strict=True)]
    assert np.isinf(distances).any()
    assert np.allclose(distances, expected)
