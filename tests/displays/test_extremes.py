"""Extreme values in every field of every message that a display reads."""

from __future__ import annotations

import copy
import time
from collections.abc import Callable, Iterator
from dataclasses import fields as dataclass_fields
from typing import Any

import numpy as np
import photos
import pytest
from autoware_scenes import AUTOWARE_MESSAGES
from clouds import CLOUD, xyz_cloud
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mapping_scenes import MAPPING_MESSAGES
from moveit_scenes import MOVEIT_MESSAGES
from perception_scenes import PERCEPTION_MESSAGES
from plain_scenes import PLAIN_MESSAGES
from rtabmap_scenes import RTABMAP_MESSAGES

from webviz import Display
from webviz.api.display import inputs, inputs_of
from webviz.api.nodes import Node, has_content
from webviz.data.messages import encode
from webviz.data.messages.classes import DTYPES
from webviz.data.messages.typestore import MessageField, fields
from webviz.engine.pipeline.runner import NOTHING_TO_DRAW
from webviz.shell.testing.messages import header
from webviz_displays.areas import GridCells, Polygon
from webviz_displays.autoware import (
    AutowarePath,
    AutowareTrajectory,
    DetectedObjects,
    PoseHistory,
    PredictedObjects,
    TrackedObjects,
)
from webviz_displays.autoware.look import FootprintView
from webviz_displays.autoware.objects_look import ShapeView
from webviz_displays.grid_map import GridMap
from webviz_displays.image_plane import ImagePlane
from webviz_displays.imu import Imu, Mag
from webviz_displays.imu.imu import AccelerationSettings
from webviz_displays.laser_scan import LaserScan
from webviz_displays.map import Costmap, Map
from webviz_displays.map_cloud import MapCloud
from webviz_displays.map_graph import MapGraph
from webviz_displays.map_info import MapInfo
from webviz_displays.moveit import MotionPlanningTasks, PlanningScene, RobotState, Trajectory
from webviz_displays.nvblox import NvbloxMesh, NvbloxVoxelBlockLayer
from webviz_displays.octomap import OccupancyGrid, OccupancyMap
from webviz_displays.odometry import Odometry
from webviz_displays.path import Path
from webviz_displays.point_cloud2 import PointCloud2
from webviz_displays.poses import (
    ParticleCloud,
    PointStamped,
    Pose,
    PoseArray,
    PoseWithCovariance,
)
from webviz_displays.robot_model import RobotModel
from webviz_displays.sensors import FluidPressure, PointCloud, Range, Temperature
from webviz_displays.shared.geometry import FARTHEST
from webviz_displays.shared.pose_properties import PoseShape
from webviz_displays.vectors import AccelStamped, Effort, Twist, TwistStamped, Wrench
from webviz_displays.voxel_grid import VoxelGrid
from webviz_displays.zed import ZedOdDisplay

Benches = Callable[..., Any]
Values = dict[str, Any]
Case = tuple[tuple[str | int, ...], Any]
"""Where in a message, and the value that is put there."""

UNTURNED = {"w": 1.0}
GRID = {
    "info": {"width": 3, "height": 2, "resolution": 0.5, "origin": {"orientation": UNTURNED}},
    "data": [0, 30, 60, 98, 100, -1],
}
MESSAGES: dict[str, Values] = {
    "sensor_msgs/msg/LaserScan": {
        "angle_min": -1.0,
        "angle_max": 1.0,
        "angle_increment": 0.5,
        "time_increment": 0.001,
        "scan_time": 0.1,
        "range_min": 0.1,
        "range_max": 30.0,
        "ranges": [1.0, 2.0, 3.0, 4.0, 5.0],
        "intensities": [10.0, 20.0, 30.0, 40.0, 50.0],
    },
    "nav_msgs/msg/OccupancyGrid": GRID,
    "map_msgs/msg/OccupancyGridUpdate": {"x": 1, "y": 0, "width": 1, "height": 1, "data": [77]},
    "nav_msgs/msg/Odometry": {
        "pose": {"pose": {"orientation": UNTURNED}, "covariance": np.eye(6).ravel()},
        "child_frame_id": "base_link",
    },
    "nav_msgs/msg/Path": {
        "poses": [{"pose": {"position": {"x": x}, "orientation": UNTURNED}} for x in (0.0, 1.0)]
    },
    photos.RAW: photos.raw(photos.room(16, 12)[1], "32FC1"),
    CLOUD: xyz_cloud([(1, 0, 0), (2, 0, 1), (3, 1, 2)], {"intensity": [1, 2, 3]}),
    "std_msgs/msg/String": {
        "data": "<robot name='r'><link name='sensor'><visual><geometry><sphere radius='1'/>"
        "</geometry></visual></link><link name='arm'/><joint name='elbow' type='continuous'>"
        "<parent link='arm'/><child link='sensor'/></joint></robot>"
    },
    **PLAIN_MESSAGES,
    **MAPPING_MESSAGES,
    **PERCEPTION_MESSAGES,
    **AUTOWARE_MESSAGES,
    **RTABMAP_MESSAGES,
    **MOVEIT_MESSAGES,
}
"""A message of each type that draws something."""

DISPLAYS: list[Callable[[], Display]] = [
    LaserScan,
    lambda: LaserScan(color_transformer="AxisColor", style="Boxes", decay_time=1.0),
    Map,
    lambda: Map(use_timestamp=True, color_scheme="costmap"),
    Odometry,
    lambda: Odometry(shape=PoseShape(value="Axes")),
    Path,
    lambda: Path(line_style="Billboards", pose_style="Axes"),
    lambda: Path(pose_style="Arrows"),
    PointCloud2,
    lambda: PointCloud2(color_transformer="RGB8", style="Points", decay_time=1.0),
    lambda: PointCloud2(color_transformer="AxisColor", style="Boxes", voxel_size=0.1),
    RobotModel,
    Pose,
    lambda: Pose(shape="Axes", history_length=3),
    PoseWithCovariance,
    PoseArray,
    lambda: PoseArray(shape="Arrow (3D)", history_length=3),
    lambda: ParticleCloud(shape="Axes"),
    ParticleCloud,
    PointStamped,
    Polygon,
    GridCells,
    Wrench,
    lambda: Wrench(accept_nan_values=True, history_length=3),
    TwistStamped,
    AccelStamped,
    lambda: Twist(reference_frame="sensor"),
    Effort,
    Range,
    Temperature,
    FluidPressure,
    lambda: PointCloud(style="Boxes"),
    OccupancyGrid,
    OccupancyMap,
    GridMap,
    ImagePlane,
    lambda: GridMap(height_transformer="Flat", color_transformer="ColorLayer"),
    MapGraph,
    MapInfo,
    NvbloxMesh,
    NvbloxVoxelBlockLayer,
    lambda: VoxelGrid(show_unknown=True, show_free=True),
    Costmap,
    lambda: Imu(acceleration_properties=AccelerationSettings(enable_acceleration=True)),
    lambda: Mag(is_2d=False),
    PlanningScene,
    lambda: Trajectory(show_trail=True),
    MotionPlanningTasks,
    RobotState,
    ZedOdDisplay,
    AutowarePath,
    DetectedObjects,
    TrackedObjects,
    PredictedObjects,
    lambda: DetectedObjects(shape=ShapeView(shape_type="Fill")),
    lambda: AutowareTrajectory(view_footprint=FootprintView(value=True)),
    PoseHistory,
    MapCloud,
    lambda: MapCloud(cloud_from_scan=True),
]

MAX_CASES = 128
"""Of one message; of twice as many every other one is tried."""

LAST = "\x7f"
"""Stands for bytes that are not UTF-8."""


def extremes(field: MessageField) -> list[Any]:
    """Values for a field that is not a message itself."""
    if field.base == "string":
        texts = ["", "/", LAST, "x" * 70_000, "no such frame", "\N{SNOWMAN}\n\t%s{}<b>"]
        return texts if field.size is None else [[], *([text] for text in texts), texts]
    dtype = DTYPES[field.base]
    if dtype.kind == "b":
        values = [False, True]
    elif dtype.kind == "f":
        limits = np.finfo(dtype)
        large = [float(limits.max), -float(limits.max), float(limits.smallest_subnormal)]
        values = [float("nan"), float("inf"), -float("inf"), *large, 1e12, -1.0, 0.0]
    else:
        limits = np.iinfo(dtype)
        values = sorted({int(limits.min), int(limits.max), 0, 1})
    if field.size is None:
        return values
    counts = [count for count in (0, 1, 5, 1000) if not field.most or count <= field.most]
    return [[value] * (field.size or count) for value in values for count in counts]


def cases(type_name: str, values: Values, path: tuple[str | int, ...] = ()) -> Iterator[Case]:
    """An extreme value for each field of a message, those of its parts included."""
    for field in fields(type_name):
        here, value = (*path, field.name), values.get(field.name)
        if not field.is_message:
            yield from ((here, extreme) for extreme in extremes(field))
        elif field.size is None:
            yield from cases(field.base, value or {}, here)
        else:
            yield here, []
            for index, element in enumerate(value or ()):
                yield from cases(field.base, element, (*here, index))


def changed(values: Values, case: Case) -> None:
    """Put an extreme value in its place; a place that is gone stays gone."""
    (*path, last), value = case
    part: Any = values
    for key in path:
        if isinstance(key, int) and key >= len(part):
            return
        part = part[key] if isinstance(key, int) else part.setdefault(key, {})
    part[last] = value


def send(at: Any, name: str, values: Values) -> None:
    """Publish a message and let the display draw it, slow work included."""
    type_name = inputs_of(type(at.display))[name].type
    if fields(type_name)[0].base == "std_msgs/msg/Header":
        values.setdefault("header", header("sensor", at.now_ns))
    cdr = encode(type_name, values).replace(LAST.encode(), b"\xff")
    topic = next(topic.name for input, _, topic in inputs(at.display) if input == name)
    at.send_bytes(type_name, cdr, topic)
    at.turn()
    deadline = time.monotonic() + 60
    while at.runner.is_busy():
        assert time.monotonic() < deadline
        time.sleep(0.005)
        at.turn()


def faults(at: Any) -> list[str]:
    """Return violations of what must hold however odd a message is."""
    found, nodes = [], at.nodes()
    for key, node in nodes.items():
        found += [f"{key}.{name} is not finite" for name in infinite(node)]
    for key, pose in at.poses().items():
        if not np.isfinite([*pose.position, *pose.wxyz]).all():
            found.append(f"the pose of {key} is not finite")
    box = None if found else at.scene.bounds("")
    if box is not None and not np.abs([box.low, box.high]).max() < 4 * FARTHEST:
        found.append(f"it reaches to {box}")
    said = at.statuses()
    silent = all(level == "OK" or text == NOTHING_TO_DRAW.text for level, text in said.values())
    is_blank = not type(at.display).reports_only and not any(map(has_content, nodes.values()))
    if is_blank and silent:
        found.append(f"nothing is drawn, and only this is said: {said}")
    return found


def infinite(node: Node) -> Iterator[str]:
    for field in dataclass_fields(node):
        value = getattr(node, field.name)
        if field.name == "ids":
            continue  # names, or numbers of items
        if isinstance(value, float | np.ndarray) and not np.isfinite(value).all():
            yield field.name


def at_work(bench: Benches, make: Callable[[], Display], name: str) -> Any:
    at = bench(make())
    at.transform("map", "sensor", (1.0, 2.0, 0.0), (0.0, 0.0, 0.6, 0.8))
    for number, (other, spec) in enumerate(inputs_of(type(at.display)).items()):
        if other != name and (number == 0 or spec.latched):
            send(at, other, copy.deepcopy(MESSAGES[spec.type]))
    return at


INPUTS = [
    pytest.param(make, name, id=f"{type(make()).__name__}-{name}-{number}")
    for number, make in enumerate(DISPLAYS)
    for name in inputs_of(type(make()))
    if inputs_of(type(make()))[name].type in MESSAGES
]


@pytest.fixture(autouse=True)
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    """Statuses name a missing transform at once."""
    monkeypatch.setattr("webviz.engine.pipeline.input_subscription.PATIENCE_S", -1.0)


@pytest.mark.parametrize(("make", "name"), INPUTS)
def test_an_extreme_value_is_never_drawn_as_nonsense_nor_left_out_in_silence(
    bench: Benches, make: Callable[[], Display], name: str
) -> None:
    type_name = inputs_of(type(make()))[name].type
    found = []
    known = list(cases(type_name, MESSAGES[type_name]))
    for case in known[:: len(known) // MAX_CASES or 1]:
        values = copy.deepcopy(MESSAGES[type_name])
        changed(values, case)
        at = at_work(bench, make, name)
        send(at, name, values)
        found += [f"{case[0]} = {str(case[1])[:40]}: {fault}" for fault in faults(at)]
    assert found == []


@pytest.mark.parametrize(("make", "name"), INPUTS)
@settings(
    max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(data=st.data())
def test_several_extreme_values_at_once_are_no_worse(
    bench: Benches, make: Callable[[], Display], name: str, data: st.DataObject
) -> None:
    type_name = inputs_of(type(make()))[name].type
    known = list(cases(type_name, MESSAGES[type_name]))
    at = at_work(bench, make, name)
    for _ in range(data.draw(st.integers(1, 3))):
        values = copy.deepcopy(MESSAGES[type_name])
        for index in data.draw(st.lists(st.integers(0, len(known) - 1), max_size=5)):
            changed(values, known[index])
        send(at, name, values)
        at.now_ns += 10**8
        assert faults(at) == []
