"""RTAB-Map's graph with the images and scans of its nodes."""

from __future__ import annotations

import io
import zlib
from collections.abc import Callable
from typing import Any

import numpy as np
import photos
from numpy.typing import NDArray
from PIL import Image

Values = dict[str, Any]

MAP_DATA = "rtabmap_msgs/msg/MapData"
OPTICAL = {"rotation": {"x": -0.5, "y": 0.5, "z": -0.5, "w": 0.5}}
"""Transform of a camera that looks along x of the robot."""


def zipped(matrix: NDArray[np.float32]) -> NDArray[np.uint8]:
    """A scan (N, channels), as RTAB-Map compresses matrices of OpenCV."""
    count, channels = matrix.shape
    trailer = np.array([1, count, 5 + 8 * (channels - 1)], "<i4").tobytes()
    data = zlib.compress(np.ascontiguousarray(matrix, "<f4").tobytes()) + trailer
    return np.frombuffer(data, np.uint8)


def float_png(depths: NDArray[np.float32]) -> NDArray[np.uint8]:
    """Depths in metres, as OpenCV writes their bytes as blue, green, red and alpha."""
    bgra = np.ascontiguousarray(depths, "<f4").view(np.uint8).reshape(*depths.shape, 4)
    file = io.BytesIO()
    Image.fromarray(bgra[..., [2, 1, 0, 3]], "RGBA").save(file, "PNG")
    return np.frombuffer(file.getvalue(), np.uint8)


def millimetres(depths: NDArray[np.float32]) -> NDArray[np.uint8]:
    """Depths in metres as a PNG of 16 bits."""
    return photos.png16(np.nan_to_num(1000 * depths).astype(np.uint16))["data"]


def rgbd(
    colors: NDArray[np.uint8],
    depths: NDArray[np.float32],
    pack: Callable[[NDArray[np.float32]], NDArray[np.uint8]] = millimetres,
) -> Values:
    """The data of one camera."""
    return {
        "left_compressed": photos.jpeg(colors)["data"],
        "right_compressed": pack(depths),
        "left_camera_info": [photos.info(depths.shape[1], depths.shape[0])],
        "local_transform": [OPTICAL],
    }


def scanned(*points: tuple[float, ...], format: int = 6) -> Values:
    """The data of a lidar 0.5 m above the floor."""
    return {
        "laser_scan_compressed": zipped(np.array(points, np.float32)),
        "laser_scan_format": format,
        "laser_scan_local_transform": {
            "translation": {"z": 0.5},
            "rotation": {"w": 1.0},
        },
    }


def map_data(places: dict[int, tuple[float, float]], nodes: dict[int, Values]) -> Values:
    """A graph with the places of nodes, and the data of some of them, a second apart."""
    return {
        "graph": {
            "poses_id": list(places),
            "poses": [
                {"position": {"x": x, "y": y}, "orientation": {"w": 1.0}}
                for x, y in places.values()
            ],
        },
        "nodes": [
            {"id": id, "stamp": 100.0 * id, "pose": {"orientation": {"w": 1.0}}, "data": data}
            for id, data in nodes.items()
        ],
    }


SCAN = ((1.0, 0.0, 0.0, 10.0), (2.0, 1.0, 0.5, 90.0), (3.0, -1.0, 1.0, 40.0))
BOTH = {**rgbd(*photos.room(32, 24)), **scanned(*SCAN)}
"""A node that has images and a scan."""
MAPPED = map_data({1: (0.0, 0.0), 2: (2.0, 1.0)}, {1: BOTH, 2: BOTH})

INFO = "rtabmap_msgs/msg/Info"
CLOSED = {
    "ref_id": 12,
    "loop_closure_id": 3,
    "loop_closure_transform": {"translation": {"x": 0.5}, "rotation": {"w": 1.0}},
    "stats_keys": ["Loop/Accepted_hypothesis_id/", "Timing/Total/ms"],
    "stats_values": [3.0, 41.25],
}
"""Information of a node that closes a loop."""

RTABMAP_MESSAGES: dict[str, Values] = {MAP_DATA: MAPPED, INFO: CLOSED}
"""A message of each type that draws something."""
