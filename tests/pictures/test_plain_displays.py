"""Poses, areas, vectors and single measurements as people see them."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import photos
from autoware_scenes import expected, followed, pose_at, thing, unaccelerated
from grid_maps import grid_map
from octrees import OctreeNode, binary, full
from perception_scenes import ZED_SCENE
from rtabmap_scenes import map_data, rgbd

from webviz import Display
from webviz.api.display import inputs
from webviz.api.views import Orbit
from webviz.shell.docs import snake_case
from webviz.shell.testing import TOLERANCE, Harness, share_of_difference, turned
from webviz.shell.testing.comparing import load
from webviz_displays.areas import GridCells, Polygon
from webviz_displays.autoware import (
    AutowarePath,
    AutowareTrajectory,
    DetectedObjects,
    PoseHistory,
    PredictedObjects,
    TrackedObjects,
)
from webviz_displays.autoware.look import FootprintView, LaneView, TextView
from webviz_displays.autoware.objects_look import ClassColors, ShapeView
from webviz_displays.detections import (
    BoundingBox3D,
    BoundingBox3DArray,
    Detection3D,
    Detection3DArray,
)
from webviz_displays.grid import Grid
from webviz_displays.grid_map import GridMap
from webviz_displays.imu import Imu, Mag
from webviz_displays.imu.imu import AccelerationSettings, BoxSettings
from webviz_displays.map import Costmap
from webviz_displays.map_cloud import MapCloud
from webviz_displays.map_graph import MapGraph
from webviz_displays.nvblox import NvbloxMesh, NvbloxVoxelBlockLayer
from webviz_displays.octomap import (
    ColorOccupancyGrid,
    OccupancyGrid,
    OccupancyGridStamped,
    OccupancyMap,
    OccupancyMapStamped,
)
from webviz_displays.poses import (
    ParticleCloud,
    PointStamped,
    Pose,
    PoseArray,
    PoseWithCovariance,
)
from webviz_displays.sensors import (
    FluidPressure,
    Illuminance,
    PointCloud,
    Range,
    RelativeHumidity,
    Temperature,
)
from webviz_displays.vectors import AccelStamped, Effort, Twist, TwistStamped, Wrench
from webviz_displays.voxel_grid import VoxelGrid
from webviz_displays.zed import ZedOdDisplay

Values = dict[str, Any]


def pose(x: float, y: float, z: float = 0.0, yaw: float = 0.0) -> Values:
    return {
        "position": {"x": x, "y": y, "z": z},
        "orientation": dict(zip("xyzw", turned(yaw=yaw), strict=True)),
    }


def around(count: int, radius: float) -> list[Values]:
    """Poses on a circle that look outwards."""
    angles = [2 * math.pi * i / count for i in range(count)]
    return [pose(radius * math.cos(a), radius * math.sin(a), yaw=a) for a in angles]


def vector(x: float, y: float, z: float) -> Values:
    return {"x": x, "y": y, "z": z}


ARM = """
<robot name="arm"><link name="base_link"/><link name="sensor"/>
<joint name="elbow" type="revolute"><parent link="base_link"/><child link="sensor"/>
<axis xyz="0.3 0 1"/><limit effort="10" velocity="1" lower="0" upper="1"/></joint></robot>
"""
COVARIANCE = np.diag([0.09, 0.04, 0.0, 0.0, 0.0, 0.07]).ravel()
PUSH = {"force": vector(0.4, 0.3, 0.2), "torque": vector(0.0, 0.2, 0.7)}
MOTION = {"linear": vector(0.6, 0.0, 0.0), "angular": vector(0.0, 0.0, 0.5)}
OTHER_MOTION = {"linear": vector(0.0, -0.6, 0.0), "angular": vector(0.0, 0.0, -0.6)}
STAR = [
    vector(r * math.cos(k * math.pi / 5), r * math.sin(k * math.pi / 5), 0.0)
    for k in range(10)
    for r in [1.2 if k % 2 else 0.6]
]
CELLS = [vector(0.3 * i - 0.8, 0.3 * j - 0.8, 0.0) for i in range(6) for j in range(6) if i * j % 3]
HILL = [
    vector(0.1 * i, 0.1 * j, 0.4 * math.exp(-((i / 6) ** 2 + (j / 6) ** 2)))
    for i in range(-10, 11)
    for j in range(-10, 11)
]
STEPS = range(-10, 11)


def summit(x: float, y: float) -> float:
    """Height of a hill with a hollow, metres."""
    distance = math.hypot(x, y)
    return 0.8 * math.exp(-2.0 * distance**2) - 0.4 * math.exp(-30.0 * distance**2)


def landscape() -> OctreeNode:
    """The hill as voxels of 0.1 m, down to the ground below it."""
    root = OctreeNode()
    for x, y in product(STEPS, STEPS):
        top = int(10 * summit(x / 10, y / 10))
        for z in range(-1, top + 1):
            root.place((x, y, z), log_odds=2.0, color=(40 + 20 * top, 90 + 12 * (x % 2), 60))
    return root


def room() -> OctreeNode:
    """Walls of three voxels above a free floor, with a door."""
    root = OctreeNode()
    for x, y in product(STEPS, STEPS):
        if max(abs(x), abs(y)) < 10 or (y == -10 and abs(x) < 3):
            root.place((x, y, 0), log_odds=-2.0)
        else:
            for z in range(3):
                root.place((x, y, z), log_odds=2.0)
    return root


def obstacles() -> Values:
    """Walls around unknown space, 16 levels of 0.05 m."""
    near = [max(abs(x), abs(y)) for y in range(-10, 11) for x in range(-10, 11)]
    columns = [0x00FF_00FF if d == 8 else 0xF if d < 8 else 0 for d in near]
    return {
        "data": columns,
        "origin": vector(-1.05, -1.05, 0.0),
        "resolutions": vector(0.1, 0.1, 0.05),
        "size_x": 21,
        "size_y": 21,
        "size_z": 16,
    }


def loop() -> Values:
    """A drive that comes back to where it began, and two loop closures."""
    turns = [math.tau * number / 24 for number in range(25)]
    poses = [pose(0.9 * math.cos(a), 0.7 * math.sin(2 * a), 0.1 * a) for a in turns]
    links = [(number, number + 1, 0) for number in range(24)]
    links += [(0, 24, 1), (6, 18, 2), (3, 9, 4)]
    return {
        "poses_id": range(25),
        "poses": poses,
        "links": [{"from_id": a, "to_id": b, "type": type_} for a, b, type_ in links],
    }


def curve() -> Values:
    """A path around a bend, slower in its middle, between the bounds of a road."""
    points = []
    for number in range(31):
        angle = math.pi * number / 40
        x, y = 1.8 * math.sin(angle) - 1.0, 1.2 - 1.8 * math.cos(angle)
        speed = 3.0 - 2.6 * math.sin(math.pi * number / 30)
        points.append({"pose": pose_at(x, y, 0.0, angle), "longitudinal_velocity_mps": speed})
    bounds = {
        f"{side}_bound": [
            vector(r * math.sin(a / 20) - 1.0, 1.2 - r * math.cos(a / 20), 0.0) for a in range(46)
        ]
        for side, r in (("left", 1.4), ("right", 2.2))
    }
    return {"points": points, **bounds}


TRAFFIC = (
    thing(1, pose_at(-0.6, 0.3, 0.25, 0.3), 1.2, 0.6, 0.5),
    thing(7, pose_at(0.5, -0.9, 0.3), 0.3, 0.3, 0.6, kind=1),
    thing(0, pose_at(-1.2, -1.0, 0.2), 0.5, 0.5, 0.4, kind=2),
)
"""A car, a pedestrian and something else."""


def visited() -> Values:
    """The room, seen from two places."""
    images = rgbd(*photos.room())
    return map_data({1: (-1.6, -0.5), 2: (-1.0, 0.6)}, {1: images, 2: images})


def reconstructed() -> tuple[Values, Values]:
    """The hill as a mesh and as voxels of nvblox, in blocks of 0.4 m."""
    indices, meshes, voxels = [], [], []
    for x, y in product(range(-3, 3), range(-3, 3)):
        corners = [(0.4 * x + 0.1 * i, 0.4 * y + 0.1 * j) for j in range(5) for i in range(5)]
        colors = [
            {"r": 0.3 + summit(*xy), "g": 0.6, "b": 0.4 - 0.3 * xy[0], "a": 1.0} for xy in corners
        ]
        faces = [
            corner
            for j, i in product(range(4), range(4))
            for first in (5 * j + i,)
            for corner in (first, first + 1, first + 5, first + 1, first + 6, first + 5)
        ]
        indices.append({"x": x, "y": y, "z": 0})
        points = [vector(*xy, summit(*xy)) for xy in corners]
        meshes.append({"vertices": points, "colors": colors, "triangles": faces})
        centers = [vector(a, b, 0.1 * round(10 * summit(a, b))) for a, b in corners]
        voxels.append({"centers": centers, "colors": colors})
    layer = {"block_size_m": 0.4, "block_indices": indices}
    return {**layer, "blocks": meshes}, {**layer, "voxel_size_m": 0.1, "blocks": voxels}


def inflated() -> Values:
    """Costs around two obstacles."""
    cells = [
        min(math.hypot(x - 12, y - 14), math.hypot(x - 30, y - 24))
        for y in range(40)
        for x in range(40)
    ]
    costs = [254 if d < 3 else 253 if d < 5 else int(max(0, 252 - 22 * (d - 5))) for d in cells]
    origin = {"position": vector(-1.0, -1.0, 0.0), "orientation": {"w": 1.0}}
    size = {"size_x": 40, "size_y": 40, "resolution": 0.05, "origin": origin}
    return {"metadata": size, "data": costs}


SONAR = {"field_of_view": 0.5, "min_range": 0.2, "max_range": 4.0, "range": 1.4}
BOX = BoxSettings(enable_box=True, x_scale=0.6, y_scale=0.4, z_scale=0.2, box_alpha=0.6)
ACCELERATION = AccelerationSettings(enable_acceleration=True, acc_vector_scale=0.1)
TILTED = {
    "orientation": dict(zip("xyzw", turned(roll=0.3, yaw=0.5), strict=True)),
    "linear_acceleration": vector(0.0, 2.9, 9.4),
}
BIG: Values = {"style": "Spheres", "size": 0.8}


def detection(x: float, y: float, size: tuple[float, ...], kind: str, score: float) -> Values:
    """A box that stands on the ground, with what is in it."""
    box = {"center": pose(x, y, size[2] / 2, 0.3), "size": vector(*size)}
    return {"bbox": box, "results": [{"hypothesis": {"class_id": kind, "score": score}}]}


BOXES = [
    detection(-0.3, 0.6, (1.6, 0.7, 0.5), "car", 0.93),
    detection(0.7, -0.6, (0.3, 0.3, 0.8), "person", 0.71),
    detection(-0.8, -0.7, (0.4, 0.6, 0.4), "box", 0.4),
]

ALONE: list[tuple[Display, Sequence[Values]]] = [
    (Pose(shaft_length=0.8), ({"pose": pose(-0.5, 0.0, yaw=0.5)},)),
    (
        PoseWithCovariance(shaft_length=0.6),
        ({"pose": {"pose": pose(-0.3, 0.0, yaw=0.5), "covariance": COVARIANCE}},),
    ),
    (PoseArray(shape="Arrow (3D)"), ({"poses": around(9, 0.7)},)),
    (
        ParticleCloud(max_arrow_length=1.0),
        ({"particles": [{"pose": p, "weight": 0.1 * i} for i, p in enumerate(around(11, 0.3))]},),
    ),
    (
        PointStamped(history_length=3, alpha=0.7),
        tuple({"point": vector(0.5 * i - 0.5, 0.3 * i, 0.2)} for i in range(3)),
    ),
    (Polygon(), ({"polygon": {"points": STAR}},)),
    (GridCells(), ({"cell_width": 0.28, "cell_height": 0.28, "cells": CELLS},)),
    (Wrench(), ({"wrench": PUSH},)),
    (TwistStamped(), ({"twist": MOTION},)),
    (AccelStamped(linear_color=(80, 160, 255)), ({"accel": MOTION},)),
    (Twist(reference_frame="sensor"), (OTHER_MOTION,)),
    (Effort(scale=2.0, width=0.06), ({"name": ["elbow"], "effort": [6.0]},)),
    (Range(), (SONAR,)),
    (Temperature(**BIG), ({"temperature": 20.0},)),
    (FluidPressure(**BIG), ({"fluid_pressure": 101_325.0},)),
    (Illuminance(**BIG), ({"illuminance": 900.0},)),
    (RelativeHumidity(**BIG), ({"relative_humidity": 0.65},)),
    (PointCloud(size=0.06), ({"points": HILL},)),
    (OccupancyGrid(), (binary(landscape()),)),
    (ColorOccupancyGrid(voxel_coloring="Cell Color"), (full(landscape(), kind="ColorOcTree"),)),
    (OccupancyGridStamped(max_octree_depth=15), (full(landscape(), kind="OcTreeStamped"),)),
    (OccupancyMap(), (binary(room()),)),
    (OccupancyMapStamped(), (full(room(), kind="OcTreeStamped"),)),
    (GridMap(), (grid_map({"elevation": summit}, (11, 11), 0.19, (3, 4)),)),
    (VoxelGrid(show_unknown=True), (obstacles(),)),
    (MapCloud(size=0.02, cloud_decimation=1), (visited(),)),
    (MapGraph(), (loop(),)),
    (NvbloxMesh(), reconstructed()[:1]),
    (NvbloxVoxelBlockLayer(), reconstructed()[1:]),
    (Costmap(), (inflated(),)),
    (
        AutowarePath(
            view_path=LaneView(constant_width=True, width=0.5, alpha=0.6, fade_out_distance=0.6)
        ),
        (curve(),),
    ),
    (
        AutowareTrajectory(
            view_path=LaneView(value=False),
            view_footprint=FootprintView(
                value=True, vehicle_length=0.4, vehicle_width=0.25, rear_overhang=0.1
            ),
            view_text_velocity=TextView(value=True, scale=0.12),
        ),
        ({"points": curve()["points"][::5]},),
    ),
    (
        DetectedObjects(shape=ShapeView(shape_type="Fill"), color=(255, 138, 128)),
        ({"objects": list(map(unaccelerated, TRAFFIC))},),
    ),
    (
        TrackedObjects(per_class_color=ClassColors(value=True)),
        ({"objects": [followed(each, number) for number, each in enumerate(TRAFFIC)]},),
    ),
    (
        PredictedObjects(per_class_color=ClassColors(value=True)),
        ({"objects": [expected(each, number) for number, each in enumerate(TRAFFIC[:2])]},),
    ),
    (PoseHistory(), tuple({"pose": each["pose"]} for each in curve()["points"])),
    (BoundingBox3D(color=(90, 200, 255), alpha=0.8), (BOXES[0]["bbox"],)),
    (BoundingBox3DArray(only_edge=True), ({"boxes": [each["bbox"] for each in BOXES]},)),
    (Detection3D(show_class=True), (BOXES[1],)),
    (Detection3DArray(alpha=0.7, show_class=True, show_score=True), ({"detections": BOXES},)),
    (ZedOdDisplay(), (ZED_SCENE,)),
    (Imu(box_properties=BOX, acceleration_properties=ACCELERATION), (TILTED,)),
    (Mag(scale=0.6), ({"magnetic_field": vector(2e-5, 1e-5, -4e-5)},)),
]
"""Displays with what their picture shows best, and their messages in the frame sensor."""


def test_each_display_has_a_picture_of_its_own(webviz_harness: Callable[..., Harness]) -> None:
    view = Orbit(distance=4.5, yaw=-0.7, pitch=0.8, focal_point=(0.2, 0.0, 0.2))
    for display, _ in ALONE:
        display.enabled = False
    displays = (display for display, _ in ALONE)
    harness = webviz_harness(*displays, Grid(plane_cell_count=4), view=view)
    harness.transform("map", "sensor")
    without = harness.picture()
    for display, messages in ALONE:
        name = type(display).__name__
        harness.set("enabled", True, name)
        harness.publish("/robot_description", "std_msgs/msg/String", {"data": ARM})
        harness.settle()
        ((_, spec, topic), *_) = inputs(display)
        for values in messages:
            frame = None if isinstance(display, BoundingBox3D | Twist) else "sensor"
            harness.publish(topic.name, spec.type, values, frame=frame)
            harness.turn()
        harness.wait_until_drawn(name)
        picture = f"{snake_case(name)}/default"
        harness.check_picture(picture, each_display=False)
        pixels = load(Path(__file__).parent / f"{picture}.png")
        assert share_of_difference(pixels, without) > TOLERANCE, f"{name} is not to be seen"
        harness.set("enabled", False, name)
