"""A real TurtleBot 4 drives through a mapped corridor: bag, map and displays together."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import PIL.Image
import pytest
from inspecting import Benches
from numpy.typing import NDArray
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore
from scipy.ndimage import distance_transform_edt

from webviz.data.messages import decode
from webviz_displays.laser_scan import LaserScan
from webviz_displays.odometry import Odometry

DATA = Path(__file__).parents[3] / "shared/data"
BAG = DATA / "bags/macfirst_floor_take_2"
MAP = DATA / "maps/mac_1st_floor_final.pgm"
RESOLUTION, ORIGIN = 0.03, (-1.12, -39.4)
"""Resolution and origin as its .yaml says, in metres."""
BLACK = 90
"""Largest brightness of the cells above its occupied_thresh of 0.65."""
START = (-0.27, 0.045, 0.0), (0.0, 0.0, 0.0341, 0.9994)
"""Pose in the map at which the odometry began, found by fitting the first scan to the walls."""

pytestmark = pytest.mark.skipif(not BAG.exists(), reason="the bag of the TurtleBot 4 is not here")


def messages(*topics: str) -> Iterator[tuple[str, str, int, bytes]]:
    """Topic, type, time of arrival and bytes of what the bag holds."""
    with AnyReader([BAG], default_typestore=get_typestore(Stores.ROS2_HUMBLE)) as reader:
        connections = [c for c in reader.connections if c.topic in topics]
        for connection, time_ns, data in reader.messages(connections):
            yield connection.topic, connection.msgtype, time_ns, bytes(data)


def load_transforms(bench: Any) -> None:
    """All transforms of the bag at once, so that no message has to wait."""
    bench.buffer.cache_time_ns = 10**12
    for topic, type_name, _, data in messages("/tf", "/tf_static"):
        for t in decode(type_name, data).transforms:
            rotation, is_static = t.rotation, topic == "/tf_static"
            bench.buffer.set_transform(
                t.parent, t.child, t.stamp_ns, t.translation, rotation, is_static
            )


@pytest.mark.skipif(not MAP.exists(), reason="the map of the corridor is not here")
def test_the_scans_lie_on_the_walls_of_the_map(bench: Benches) -> None:
    display_bench = bench(LaserScan())
    load_transforms(display_bench)
    display_bench.transform("map", "odom", *START)
    points = []
    for _, type_name, time_ns, data in itertools.islice(messages("/scan"), 60):
        display_bench.now_ns = time_ns
        display_bench.send_bytes(type_name, data)
        display_bench.turn()
        if "points" in display_bench.nodes():
            points.append(display_bench.xyz("points")[:, :2])
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
    display_bench = bench(Odometry(keep=0), fixed_frame="odom")
    load_transforms(display_bench)
    for _, type_name, time_ns, data in messages("/odom"):
        display_bench.now_ns = time_ns
        display_bench.send_bytes(type_name, data)
    display_bench.turn()
    trail = display_bench.xyz("poses")[:, 0]
    steps = np.linalg.norm(np.diff(trail, axis=0), axis=1)
    assert {level for level, _ in display_bench.statuses().values()} == {"OK"}
    assert len(trail) > 50
    assert steps.max() < 0.2  # the robot is slow and the tolerance is 0.1 m
