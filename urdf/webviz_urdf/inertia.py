"""A link's mass and inertia as shapes, as RViz draws them."""

from __future__ import annotations

import math

import numpy as np

from webviz.nodes import Mesh, Pose, Rgb
from webviz_urdf import primitives
from webviz_urdf.robot import Inertial, Link

_RED: Rgb = (255, 0, 0)
_LEAD = 11340.0
"""Density of lead, kg/m³: RViz draws a mass as if it were a ball of lead."""
_TOLERANCE = 1e-6


def mass_sphere(link: Link) -> Mesh | None:
    """A ball of lead of the link's mass at its centre of mass, in the link's frame.

    Its radius is the cube root of 3 m / (4 π density), as in RViz. None without a positive mass.
    """
    inertial = link.inertial
    if inertial is None or inertial.mass <= 0.0:
        return None
    part = primitives.sphere(math.cbrt(0.75 * inertial.mass / (math.pi * _LEAD)))
    return _placed(part, np.eye(3), inertial)


def inertia_box(link: Link) -> Mesh | None:
    """The uniform box that has the link's mass and moments of inertia, in the link's frame.

    With principal moments I and mass m its edges are `sqrt(6 (Iy + Iz - Ix) / m)` and so on in
    turn (gz-math's `MassMatrix3::EquivalentBox`). None for a mass or inertia that no body has:
    not positive, or one moment larger than the sum of the other two.
    """
    inertial = link.inertial
    if inertial is None or inertial.mass <= 0.0:
        return None
    moments, axes = np.linalg.eigh(inertial.inertia)
    squares = 6.0 * (moments.sum() - 2.0 * moments) / inertial.mass
    if moments[0] <= 0.0 or squares.min() < -_TOLERANCE * squares.max():
        return None
    if np.linalg.det(axes) < 0.0:
        axes[:, 0] *= -1.0
    size = np.sqrt(np.maximum(squares, 0.0))
    return _placed(primitives.box(*size.tolist()), axes, inertial)


def _placed(part: primitives.Part, axes: np.ndarray, inertial: Inertial) -> Mesh:
    """`part`, given along the columns of `axes`, moved to the centre of mass."""
    turned = part.vertices @ (rotation_matrix(inertial.com) @ axes).T + inertial.com.position
    return Mesh(turned.astype(np.float32), part.faces, _RED)


def rotation_matrix(pose: Pose) -> np.ndarray:
    """float64 (3, 3): columns are the pose's axes in the outer frame."""
    w, x, y, z = pose.wxyz
    return np.array(
        (
            (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
            (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
            (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
        )
    )
