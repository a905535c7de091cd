"""Robots to draw, and the transforms that place their links."""

from __future__ import annotations

from importlib import metadata
from pathlib import Path

import pytest

import webviz_urdf
from webviz import Pose, compose
from webviz.shell.testing import ViewerUnderTest
from webviz_urdf import Robot, load_file

DEMO = Path(webviz_urdf.__file__).parent / "demo/robot.urdf"


def find_robots() -> Path | None:
    """The folder of example-robot-data, if it is installed."""
    try:
        package = metadata.distribution("example-robot-data")
    except metadata.PackageNotFoundError:
        return None
    return Path(str(package.locate_file("cmeel.prefix/share/example-robot-data/robots")))


def robots_folder() -> Path:
    """The folder of example-robot-data; skips the test if it is not installed."""
    if (folder := find_robots()) is None:
        pytest.skip("example-robot-data is not installed (it is in the extra 'test')")
    return folder


def link_poses(robot: Robot) -> dict[str, Pose]:
    """The pose of each link in the root, all joints at zero."""
    joints = {joint.child: joint for joint in robot.joints.values()}
    poses = {robot.root: Pose()}
    for link in robot.links:
        chain = []
        while link not in poses:
            chain.append(joints[link])
            link = joints[link].parent
        for joint in reversed(chain):
            poses[joint.child] = compose(poses[joint.parent], joint.origin)
    return poses


def place_links(harness: ViewerUnderTest, file: Path, below: str = "map") -> None:
    """Transforms of a robot with all joints at zero, its root on the origin of a frame."""
    for link, pose in link_poses(load_file(file)).items():
        w, x, y, z = pose.wxyz
        if link != below:
            harness.transform(below, link, pose.position, (x, y, z, w))
