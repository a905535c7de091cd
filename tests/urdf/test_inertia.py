"""Mass and inertia drawn as bodies that have them."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from webviz.api.nodes import Pose
from webviz_urdf import Inertial, Link, inertia_box, mass_sphere


def link(mass: float, inertia: np.ndarray, com: Pose | None = None) -> Link:
    return Link("l", inertial=Inertial(mass, com or Pose(), inertia))


def moments(size: tuple[float, float, float], mass: float) -> np.ndarray:
    """Inertia of a uniform box, kg m²."""
    x, y, z = (edge**2 for edge in size)
    return np.diag((y + z, x + z, x + y)) * mass / 12


def test_the_sphere_has_the_mass_of_lead() -> None:
    node = mass_sphere(link(3.0, np.eye(3), Pose((1.0, 2.0, 3.0))))
    assert node is not None
    assert node.color == (255, 0, 0)
    np.testing.assert_allclose(node.vertices.mean(axis=0), (1, 2, 3), atol=1e-5)
    radius = np.linalg.norm(node.vertices - (1, 2, 3), axis=1)
    np.testing.assert_allclose(4 / 3 * np.pi * radius**3 * 11340, 3.0, rtol=1e-4)


edges = st.floats(0.1, 10)


@settings(max_examples=50, deadline=None)
@given(st.tuples(edges, edges, edges), st.floats(0.01, 100), st.tuples(*[st.floats(-3, 3)] * 6))
def test_the_box_has_the_inertia_of_the_link_wherever_it_is_turned(
    size: tuple[float, float, float], mass: float, angles: tuple[float, ...]
) -> None:
    com = Rotation.from_euler("xyz", angles[:3])
    turned = Rotation.from_euler("xyz", angles[3:]).as_matrix()
    inertia = turned @ moments(size, mass) @ turned.T
    x, y, z, w = com.as_quat().tolist()
    node = inertia_box(link(mass, inertia, Pose((1.0, 0.0, 0.0), (w, x, y, z))))
    assert node is not None
    body = trimesh.Trimesh(node.vertices, node.faces)
    assert body.volume > 0
    np.testing.assert_allclose(body.center_mass, (1, 0, 0), atol=1e-3)
    body.density = mass / body.volume
    expected = com.as_matrix() @ inertia @ com.as_matrix().T
    np.testing.assert_allclose(body.moment_inertia, expected, atol=1e-3 * inertia.max())


def test_the_box_of_a_cube_keeps_the_axes_of_the_description() -> None:
    node = inertia_box(link(1.0, moments((1, 1, 1), 1.0) + np.full((3, 3), 1e-9)))
    assert node is not None
    np.testing.assert_allclose(np.abs(node.vertices), 0.5, atol=1e-6)


@pytest.mark.parametrize(
    ("mass", "inertia"),
    [
        (0.0, np.eye(3)),
        (-1.0, np.eye(3)),
        (1.0, np.zeros((3, 3))),
        (1.0, np.diag((1.0, 1.0, 3.0))),
        (1.0, np.diag((-1.0, 1.0, 1.0))),
        (1e-300, np.eye(3)),
    ],
)
def test_impossible_inertias_are_not_drawn(mass: float, inertia: NDArray[np.float64]) -> None:
    assert inertia_box(link(mass, inertia)) is None


def test_a_link_without_mass_has_neither() -> None:
    assert mass_sphere(Link("l")) is None
    assert inertia_box(Link("l")) is None
    assert mass_sphere(link(0.0, np.eye(3))) is None


def test_a_thin_plate_is_drawn_flat() -> None:
    node = inertia_box(link(1.0, moments((1, 2, 0), 1.0)))
    assert node is not None
    assert sorted(np.ptp(node.vertices, axis=0)) == pytest.approx([0, 1, 2], abs=1e-3)
