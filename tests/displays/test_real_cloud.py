"""A real cloud of a lidar on a street, read whole and coloured by what it says."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from clouds import CLOUD
from inspecting import Benches

from webviz_displays.point_cloud2 import PointCloud2

PCD = Path(__file__).parents[3] / "shared/data/clouds/251370668.pcd"

pytestmark = pytest.mark.skipif(not PCD.exists(), reason="the cloud of the street is not here")


@pytest.fixture
def street() -> dict[str, Any]:
    """The file as a message; its header is text, its data are x, y, z, intensity as float32."""
    head, _, data = PCD.read_bytes().partition(b"DATA binary\n")
    lines = [line.split() for line in head.decode().splitlines()]
    names = next(line[1:] for line in lines if line[0] == "FIELDS")
    count = next(int(line[1]) for line in lines if line[0] == "POINTS")
    fields = [
        {"name": name, "offset": 4 * i, "datatype": 7, "count": 1} for i, name in enumerate(names)
    ]
    points = np.frombuffer(data, np.uint8, 4 * len(names) * count)
    step = 4 * len(names)
    size = {"height": 1, "width": count, "point_step": step, "row_step": step * count}
    return {**size, "fields": fields, "data": points}


def test_every_point_of_a_real_cloud_is_where_it_was_measured(
    bench: Benches, street: dict[str, Any]
) -> None:
    at = bench(PointCloud2())
    at.transform("map", "lidar", (0.0, 0.0, 2.0))
    at.send(CLOUD, street, frame="lidar")
    at.turn()
    values = street["data"].view("<f4").reshape(-1, 4)
    node = at.nodes()["points"]
    np.testing.assert_allclose(at.xyz("points"), values[:, :3] + (0, 0, 2), atol=1e-4)
    assert at.statuses()["Points"] == ("OK", "Showing 69 088 of 69 088 points.")
    dim, bright = node.colors[values[:, 3].argmin()], node.colors[values[:, 3].argmax()]
    assert (dim.tolist(), bright.tolist()) == ([255, 0, 0], [255, 0, 255])


def test_voxels_thin_near_the_lidar_most(bench: Benches, street: dict[str, Any]) -> None:
    at = bench(PointCloud2(voxel_size=0.5))
    at.transform("map", "lidar")
    at.send(CLOUD, street, frame="lidar")
    at.turn()
    before = np.linalg.norm(street["data"].view("<f4").reshape(-1, 4)[:, :3], axis=1)
    after = np.linalg.norm(at.xyz("points"), axis=1)
    assert (after < 10).sum() / (before < 10).sum() < 0.5 * (after > 30).sum() / (before > 30).sum()
