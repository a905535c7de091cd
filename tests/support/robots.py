"""Robots to draw, and the transforms that place their links."""

from __future__ import annotations

from importlib import metadata
from pathlib import Path

import pytest

import webviz_urdf
from webviz.shell.testing import Shown
from webviz_urdf import load_file

DEMO = Path(webviz_urdf.__file__).parent / "demo/robot.urdf"


def robots_folder() -> Path:
    try:
        package = metadata.distribution("example-robot-data")
    except metadata.PackageNotFoundError:
        pytest.skip("example-robot-data is not installed (it is in the extra 'test')")
    return Path(str(package.locate_file("cmeel.prefix/share/example-robot-data/robots")))


def place_links(seen: Shown, file: Path, below: str = "map") -> None:
    """Transforms of a robot with all joints at zero, its root on the origin of a frame."""
    for link, pose in load_file(file).fk().items():
        w, x, y, z = pose.wxyz
        if link != below:
            seen.transform(below, link, pose.position, (x, y, z, w))
