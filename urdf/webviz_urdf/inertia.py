"""A link's mass and inertia as shapes, as RViz draws them."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from webviz.api.nodes import Mesh, Rgb
from webviz.data.rotations import matrices
from webviz_urdf import primitives
from webviz_urdf.glb import MeshPart
from webviz_urdf.robot import Inertial, Link

_RED: Rgb = (255, 0, 0)
_LEAD = 11340.0
"""Density of lead, kg/m³: RViz draws a mass as a sphere of lead."""
_TOLERANCE = 1e-6


def mass_sphere(link: Link) -> Mesh | None:
    """Return a sphere of lead of the link's mass at its centre of mass, in the link's frame.

    Its radius is the cube root of 3 m / (4 π density), as in RViz. None without a positive mass.
    """
    inertial = link.inertial
    if inertial is None or inertial.mass <= 0.0:
        return None
    part = primitives.sphere(math.cbrt(0.75 * inertial.mass / (math.pi * _LEAD)))
    return _placed(part, np.eye(3), inertial)


def inertia_box(link: Link) -> Mesh | None:
    """Return the uniform box that has the link's mass and moments of inertia, in the link's frame.

    With principal moments I and mass m its edges are `sqrt(6 (Iy + Iz - Ix) / m)` and so on
    (gz-math's `MassMatrix3::EquivalentBox`). None for a physically impossible mass or inertia: not
    positive, or one moment larger than the sum of the other two.
    """
    inertial = link.inertial
    if inertial is None or inertial.mass <= 0.0:
        return None
    moments, axes = _principal(inertial.inertia)
    squares = 6.0 * (moments.sum() - 2.0 * moments) / inertial.mass
    # A box of 10¹² m is the result of a mistyped mass.
    if moments.min() <= 0.0 or squares.max() > 1e24 or squares.min() < -_TOLERANCE * squares.max():
        return None
    size = np.sqrt(np.maximum(squares, 0.0))
    return _placed(primitives.box(*size.tolist()), axes, inertial)


def _principal(inertia: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Principal moments (3,) and, as columns of (3, 3), right-handed principal axes.

    If the products of inertia are only noise, the given axes are kept: equal moments, as of a cube,
    have no distinct principal axes and would turn the box at random.
    """
    products = inertia - np.diag(np.diag(inertia))
    if np.abs(products).max() <= _TOLERANCE * np.abs(inertia).max():
        return np.diag(inertia), np.eye(3)
    moments, axes = np.linalg.eigh(inertia)
    if np.linalg.det(axes) < 0.0:
        axes[:, 0] *= -1.0
    return moments, axes


def _placed(part: MeshPart, axes: NDArray[np.float64], inertial: Inertial) -> Mesh:
    """`part`, given along the columns of `axes`, moved to the centre of mass."""
    turned = part.vertices @ (matrices(inertial.com.wxyz) @ axes).T + inertial.com.position
    return Mesh(turned.astype(np.float32), part.faces, _RED)
