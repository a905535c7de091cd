"""The robots of the PyPI package example-robot-data: real files with real faults."""

from __future__ import annotations

import functools
from xml.etree import ElementTree

import numpy as np
import pytest
from robots import find_robots, link_poses
from small_robots import as_trimesh

from webviz import compose
from webviz.api.nodes import Glb, Mesh
from webviz.data.rotations import matrices
from webviz_urdf import Robot, RobotDescriptionError, inertia_box, load_file, mass_sphere

ROBOTS = find_robots()
FILES = sorted(str(f.relative_to(ROBOTS)) for f in ROBOTS.rglob("*.urdf")) if ROBOTS else []
pytestmark = pytest.mark.skipif(
    not FILES, reason="example-robot-data is not installed (it is in the extra 'test')"
)


@functools.lru_cache(maxsize=2)
def load(file: str) -> Robot:
    """Load one; the last two are kept for the tests that follow."""
    assert ROBOTS is not None
    return load_file(ROBOTS / file)


def test_there_are_69_robots() -> None:
    assert len(FILES) == 69


@pytest.mark.parametrize("file", FILES)
def test_every_visual_is_drawn_or_reported_as_missing(file: str) -> None:
    assert ROBOTS is not None
    declared = ElementTree.parse(ROBOTS / file).getroot()
    if declared.find("link") is None:
        with pytest.raises(RobotDescriptionError, match="no <link>"):
            load(file)
        return
    robot = load(file)
    for kind in ("visual", "collision"):
        count = sum(len(getattr(link, f"{kind}s")) for link in robot.links.values())
        missing = [m for m in robot.missing if m.kind == kind]
        assert count + len(missing) == len(declared.findall(f"link/{kind}"))
        # romeo_laas_small names meshes in Ogre's format on its author's disk.
        assert not missing or "romeo_laas" in file
    assert link_poses(robot).keys() == robot.links.keys()
    for link in robot.links.values():
        assert (mass_sphere(link) is None) <= (inertia_box(link) is None)


def extents(robot: Robot) -> np.ndarray:
    """Size of the robot along x, y, z of its root, joints at zero, in metres."""
    poses = link_poses(robot)
    corners = []
    for link in robot.links.values():
        for shape in link.visuals:
            pose = compose(poses[link.name], shape.pose)
            vertices = as_trimesh(shape.node).vertices
            corners.append(vertices @ matrices(pose.wxyz).T + pose.position)
    return np.ptp(np.concatenate(corners), axis=0)


@pytest.mark.parametrize(
    ("file", "height"),
    [
        # Files named .DAE; without the pedestal's feet.
        ("baxter_description/urdf/baxter.urdf", 1.78),
        # COLLADA with seven colours; wrist at 0.333 + 0.316 + 0.384 m by its maker.
        ("panda_description/urdf/panda.urdf", 1.033 + 0.07),
        # Binary .STL, the right side mirrored; 1.75 m by its maker.
        ("talos_data/robots/talos_reduced.urdf", 1.75),
        # COLLADA with textures, scaled by the description; legs straight down.
        ("anymal_c_simple_description/urdf/anymal.urdf", 0.9),
    ],
)
def test_robots_are_as_tall_as_the_real_ones(file: str, height: float) -> None:
    assert extents(load(file))[2] == pytest.approx(height, rel=0.1)


def test_the_textures_of_anymal_are_kept() -> None:
    robot = load("anymal_c_simple_description/urdf/anymal.urdf")
    nodes = [shape.node for link in robot.links.values() for shape in link.visuals]
    assert sum(isinstance(node, Glb) and b"image/jpeg" in node.data for node in nodes) == 45


def test_mirrored_meshes_of_talos_are_not_inside_out() -> None:
    robot = load("talos_data/robots/talos_reduced.urdf")
    right = [link for name, link in robot.links.items() if "right" in name]
    volumes = [as_trimesh(shape.node).volume for link in right for shape in link.visuals]
    assert len(volumes) > 10
    assert min(volumes) > 0.0


def test_materials_that_allegro_defines_in_one_link_colour_the_others() -> None:
    robot = load("allegro_hand_description/urdf/allegro_right_hand.urdf")
    nodes = [shape.node for link in robot.links.values() for shape in link.visuals]
    colors = [node.color for node in nodes if isinstance(node, Mesh)]
    assert len(colors) == 21
    assert (255, 0, 0) not in colors
