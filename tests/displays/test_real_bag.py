"""A real TurtleBot 4 drives through a mapped corridor: bag, map and displays together."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import PIL.Image
from inspecting import Benches
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt
from turtlebot import MAP, ORIGIN, RESOLUTION, START, messages, needs_bag, needs_map

from webviz.data.messages import decode
from webviz.shell.testing import DisplayBench
from webviz_displays.laser_scan import LaserScan
from webviz_displays.odometry import Odometry

BLACK = 90
"""Largest brightness of the cells above its occupied_thresh of 0.65."""
pytestmark = needs_bag


def load_transforms(bench: DisplayBench) -> None:
    """All transforms of the bag at once, so that no message has to wait."""
    bench.buffer.cache_time_ns = 10**12
    for topic, type_name, _, data in messages("/tf", "/tf_static"):
        for t in decode(type_name, data).transforms:
            rotation, is_static = t.rotation, topic == "/tf_static"
            bench.buffer.set_transform(
                t.parent, t.child, t.stamp_ns, t.translation, rotation, is_static
            )


@needs_map
def test_the_scans_lie_on_the_walls_of_the_map(bench: Benches) -> None:
    at = bench(LaserScan())
    load_transforms(at)
    at.transform("map", "odom", *START)
    points = []
    for _, type_name, time_ns, data in itertools.islice(messages("/scan"), 60):
        at.now_ns = time_ns
        at.send_bytes(type_name, data)
        at.turn()
        if "points" in at.nodes():
            points.append(at.xyz("points")[:, :2])
    assert len(points) > 50
    hits = np.concatenate(points)
    assert share_on_walls(hits) > 0.85
    assert share_on_walls(hits + np.array((0.3, 0.3))) < 0.6  # the measure can tell


def share_on_walls(hits: NDArray[np.float64]) -> float:
    """Return the number of points (N, 2) of the map's frame within two cells (6 cm) of a wall."""
    columns, rows = np.floor((hits - ORIGIN) / RESOLUTION).astype(int).T
    picture = np.flipud(np.asarray(PIL.Image.open(MAP)))
    to_wall: Any = distance_transform_edt(picture > BLACK)
    return float(np.mean(to_wall[rows, columns] <= 2))


def test_odometry_and_its_covariances_are_drawn_without_complaint(bench: Benches) -> None:
    at = bench(Odometry(keep=0), fixed_frame="odom")
    load_transforms(at)
    for _, type_name, time_ns, data in messages("/odom"):
        at.now_ns = time_ns
        at.send_bytes(type_name, data)
    at.turn()
    trail = at.xyz("poses")[:, 0]
    steps = np.linalg.norm(np.diff(trail, axis=0), axis=1)
    assert {level for level, _ in at.statuses().values()} == {"OK"}
    assert len(trail) > 50
    assert steps.max() < 0.2  # the robot is slow and the tolerance is 0.1 m
