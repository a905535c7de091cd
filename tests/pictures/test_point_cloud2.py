"""PointCloud2 as people see it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from webviz.api.views import Orbit
from webviz.shell.testing import Harness
from webviz_displays.grid import Grid
from webviz_displays.point_cloud2 import PointCloud2

Stages = Callable[..., Harness]

FLOAT32 = 7
"""sensor_msgs/PointField.FLOAT32"""


def cloud() -> dict[str, Any]:
    """A wavy sheet of 16 x 16 points with intensities and packed colours."""
    x, y = (c.ravel() for c in np.meshgrid(np.linspace(-2, 2, 16), np.linspace(-2, 2, 16)))
    z = 0.5 + 0.4 * np.sin(2.0 * x) * np.cos(1.5 * y)
    red, blue = (np.floor(4 * (c + 2) / 4.001).astype(np.uint32) * 80 for c in (x, y))
    rgb = (red << 16 | 90 << 8 | blue).astype(np.uint32).view(np.float32)
    points = np.column_stack([x, y, z, np.hypot(x, y), rgb]).astype(np.float32)
    points[:, 4] = rgb  # bits, not a number to be rounded
    names = ("x", "y", "z", "intensity", "rgb")
    return {
        "height": 1,
        "width": len(points),
        "fields": [
            {"name": name, "offset": 4 * i, "datatype": FLOAT32, "count": 1}
            for i, name in enumerate(names)
        ],
        "point_step": 20,
        "row_step": 20 * len(points),
        "data": np.frombuffer(points.tobytes(), np.uint8),
        "is_dense": True,
    }


def test_points_have_colours_styles_and_fewer_of_them(webviz_harness: Stages) -> None:
    view = Orbit(distance=8.0, yaw=-1.2, pitch=0.7)
    harness = webviz_harness(PointCloud2(size=0.12), Grid(plane_cell_count=8), view=view)
    harness.transform("map", "camera")
    harness.publish("/points", "sensor_msgs/msg/PointCloud2", cloud(), frame="camera")
    harness.turn()
    harness.check_picture("point_cloud2/default")
    harness.set("color_transformer", "Intensity")
    harness.check_picture("point_cloud2/intensity")
    harness.set("color_transformer", "AxisColor")
    harness.check_picture("point_cloud2/axis_z")
    harness.set("voxel_size", 0.6)
    harness.set("style", "Spheres")
    harness.set("size", 0.2)
    harness.check_picture("point_cloud2/spheres_one_per_voxel_of_0.6_m")
    harness.set("voxel_size", 0.0)
    harness.set("max_points", 50)
    harness.set("style", "Boxes")
    harness.set("color_transformer", "FlatColor")
    harness.set("color", (80, 200, 255))
    harness.set("alpha", 0.5)
    harness.check_picture("point_cloud2/50_transparent_boxes")
