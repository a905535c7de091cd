"""Messages for the displays of maps and inertial sensors, as those of `plain_scenes`."""

from __future__ import annotations

from typing import Any

from grid_maps import GRID_MAP, grid_map
from octrees import OCTOMAP, OctreeNode, full

from webviz.shell.testing import DisplayBench

SECOND = 1_000_000_000


def hill(kind: str) -> dict[str, Any]:
    """Ground of four voxels with one on top, in free air."""
    root = OctreeNode()
    for x in range(-1, 1):
        for y in range(-1, 1):
            root.place((x, y, 0), log_odds=2.0 + x, color=(200, 50 * x + 60, 0))
            root.place((x, y, 2), log_odds=-1.0, color=(0, 0, 255))
    root.place((0, 0, 1), log_odds=0.5, color=(0, 255, 0))
    return full(root, 0.5, kind)


def terrain() -> dict[str, Any]:
    """A slope with a layer of packed colours."""
    layers = {"elevation": lambda x, y: x + 2 * y, "robot": lambda x, y: 1e-38 * (3 + x)}
    return grid_map(layers, (4, 5))


VOXEL_GRID = {
    "data": [0x0003_000F, 0x0001_0003, 0, 1],
    "resolutions": {"x": 0.5, "y": 0.5, "z": 0.25},
    "size_x": 2,
    "size_y": 2,
    "size_z": 4,
}
"""Marked, unknown and free voxels."""
COSTMAP = {
    "metadata": {
        "size_x": 3,
        "size_y": 2,
        "resolution": 0.5,
        "origin": {"orientation": {"w": 1.0}},
    },
    "data": [0, 60, 130, 253, 254, 255],
}
CORNERS = ((0.0, 0.0), (0.8, 0.0), (0.0, 0.8))
COLORS = [{"r": 1.0, "a": 1.0}, {"g": 0.5, "a": 1.0}, {"b": 1.0, "a": 1.0}]
MESH = {
    "block_size_m": 0.8,
    "block_indices": [{"x": 0, "y": 0, "z": 0}, {"x": 1, "y": 0, "z": 1}, {"x": 5, "y": 0, "z": 2}],
    "blocks": [
        {
            "vertices": [{"x": 0.8 * block + x, "y": y, "z": z} for x, y in CORNERS],
            "colors": colors,
            "triangles": [0, 1, 2],
        }
        for block, z, colors in ((0, 0.1, COLORS), (1, 0.9, COLORS), (5, 1.7, []))
    ],
}
"""Triangles in three blocks; the last is without colours and above 1.5 m."""
VOXELS = {
    "block_size_m": 0.8,
    "voxel_size_m": 0.1,
    "block_indices": MESH["block_indices"],
    "blocks": [{"centers": each["vertices"], "colors": each["colors"]} for each in MESH["blocks"]],
}
"""Voxels at the corners of these triangles."""
GRAPH = {
    "poses_id": [1, 2, 3, -1],
    "poses": [
        {"position": {"x": float(x), "y": float(y)}} for x, y in ((0, 0), (1, 0), (1, 1), (2, 2))
    ],
    "links": [
        {"from_id": a, "to_id": b, "type": type_}
        for a, b, type_ in (
            *((1, 2, 0), (2, 3, 6), (3, 1, 1), (1, 3, 2), (3, 2, 4), (2, 1, 5), (3, -1, 8)),
        )
    ],
}
"""A graph with a link of each colour."""
IMU = {"orientation": {"z": 0.6, "w": 0.8}, "linear_acceleration": {"x": 1.0, "z": 9.0}}
FIELD = {"magnetic_field": {"x": 2e-5, "y": 1e-5, "z": -4e-5}}


def _map_and_update(
    bench: DisplayBench, topic: str, whole: tuple[str, Any], update: tuple[str, Any]
) -> None:
    """A map and an update of it, in a frame that moved on."""
    for age, x in ((1, 1.0), (0, 2.0)):
        stamp_ns = bench.now_ns - age * SECOND
        bench.transform("map", "room", (x, 0.0, 0.0), stamp_ns=stamp_ns)
    stamp_ns = bench.now_ns - SECOND
    for name, (type_name, values) in ((topic, whole), (f"{topic}_updates", update)):
        bench.send(type_name, values, frame="room", stamp_ns=stamp_ns, topic=name)
        bench.turn()


def costmaps(bench: DisplayBench) -> None:
    """A costmap, and an update."""
    update = {"x": 1, "size_x": 1, "size_y": 1, "data": [77]}
    whole = "nav2_msgs/msg/Costmap", COSTMAP
    changed = "nav2_msgs/msg/CostmapUpdate", update
    _map_and_update(bench, "/local_costmap/costmap_raw", whole, changed)


def seen_from_above(bench: DisplayBench) -> None:
    """An octree, and an update."""
    update = {"x": 0, "width": 1, "height": 1, "data": [30]}
    changed = "map_msgs/msg/OccupancyGridUpdate", update
    _map_and_update(bench, "/octomap_binary", (OCTOMAP, hill("OcTree")), changed)


MAPPING_MESSAGES: dict[str, dict[str, Any]] = {
    OCTOMAP: hill("OcTree"),
    GRID_MAP: terrain(),
    "nav2_msgs/msg/VoxelGrid": VOXEL_GRID,
    "rtabmap_msgs/msg/MapGraph": GRAPH,
    "nvblox_msgs/msg/Mesh": MESH,
    "nvblox_msgs/msg/VoxelBlockLayer": VOXELS,
    "nav2_msgs/msg/Costmap": COSTMAP,
    "nav2_msgs/msg/CostmapUpdate": {"x": 1, "size_x": 1, "size_y": 1, "data": [77]},
    "sensor_msgs/msg/Imu": IMU,
    "sensor_msgs/msg/MagneticField": FIELD,
}
"""A message of each type that draws something."""
