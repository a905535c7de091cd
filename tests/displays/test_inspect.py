"""Details each display reports about a selected item."""

from __future__ import annotations

import io
import math
from collections.abc import Callable, Mapping
from dataclasses import fields
from typing import Any

import numpy as np
import photos
import PIL.Image
import pytest
from autoware_scenes import FOLLOWED, PASSED, TIMED, TRACKED, TRAJECTORY
from autoware_scenes import POSE as POSE_STAMPED
from clouds import CLOUD, FLOAT32, UINT32, XYZ, cloud
from grid_maps import GRID_MAP, grid_map
from mapping_scenes import COSTMAP, FIELD, GRAPH, IMU, MESH, VOXEL_GRID, VOXELS, hill
from moveit_scenes import moveit, plan_task
from octrees import OCTOMAP
from perception_scenes import ZED_OBJECTS, ZED_SCENE
from robot_arm import ARM, describe, place_arm
from rtabmap_scenes import MAP_DATA, SCAN, map_data, scanned

from webviz import Context, Details, Display, Frames
from webviz.api.nodes import Lines, Points
from webviz.engine.commands import Picks
from webviz.engine.pipeline.details import details_tree
from webviz_displays.areas import GridCells, Polygon
from webviz_displays.autoware import AutowareTrajectory, PoseHistory, TrackedObjects
from webviz_displays.axes import Axes
from webviz_displays.grid import Grid
from webviz_displays.grid_map import GridMap
from webviz_displays.image_plane import ImagePlane
from webviz_displays.imu import Imu, Mag
from webviz_displays.laser_scan import LaserScan
from webviz_displays.map import Costmap, Map
from webviz_displays.map_cloud import MapCloud
from webviz_displays.map_graph import MapGraph
from webviz_displays.markers import MarkerArray
from webviz_displays.moveit import MotionPlanningTasks, PlanningScene, RobotState, Trajectory
from webviz_displays.nvblox import NvbloxMesh, NvbloxVoxelBlockLayer
from webviz_displays.octomap import ColorOccupancyGrid
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
from webviz_displays.sensors import PointCloud, Range, Temperature
from webviz_displays.tf import TF
from webviz_displays.vectors import Effort, Wrench
from webviz_displays.voxel_grid import VoxelGrid
from webviz_displays.zed import ZedOdDisplay

NAN = math.nan
Benches = Callable[..., Any]
QUARTER = (0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5))


def pick(at: Any, key: str, number: int | None, point: Any = None) -> Details:
    """Return the details of an item of a node, as a browser picks it, or of a point on one."""
    group = next(group for group, nodes in at.scene.groups.items() if key in nodes)
    node, _ = at.scene.groups[group][key]
    color: Any = None
    if number is not None:
        place = getattr(node, fields(node)[0].name)[number]
        point = tuple(map(float, place[0] if place.ndim > 1 else place))
        if isinstance(node, Points) and not isinstance(node.colors, tuple):
            color = tuple(node.colors[number].tolist())
    found = at.runner.find(Picks(group, key, ((7, number, point, color),)))
    details = at.runner.inspect(found[7], Frames(at.buffer, at.fixed_frame, at.now_ns))
    assert details is not None
    return details


def point_of_a_cloud(bench: Benches) -> Details:
    """The third that is drawn, of a cloud in rows, whose first two and fifth cannot be."""
    names = [*XYZ, ("intensity", 12, FLOAT32, 1), ("rgb", 16, UINT32, 1), ("ring", 20, 4, 2)]
    places = [(NAN, 0, 0), (0, NAN, 0), (1, 2, 3), (4, 5, 6), (2e9, 0, 0), (7, 8, 0.1)]
    points = [
        {
            **{axis: [value] for axis, value in zip("xyz", place, strict=True)},
            "intensity": [0.1 * i],
            "rgb": [0x00010203 + i],
            "ring": [i, 2 * i],
        }
        for i, place in enumerate(places)
    ]
    at = bench(PointCloud2())
    at.transform("map", "lidar", (0.0, 0.0, 2.0), QUARTER)
    at.send(CLOUD, cloud(names, points, height=2, row_padding=5), frame="lidar")
    at.turn()
    return pick(at, "points", 2)


def point_of_a_thinned_cloud(bench: Benches) -> Details:
    points = [{"x": [float(i)], "y": [0.0], "z": [0.0], "i": [i]} for i in range(100)]
    at = bench(PointCloud2(max_points=10, style="Boxes", color_transformer="FlatColor"))
    at.transform("map", "lidar")
    at.send(CLOUD, cloud([*XYZ, ("i", 12, UINT32, 1)], points), frame="lidar")
    at.turn()
    details = pick(at, "solids", 4)
    number = details.values["i"]
    assert number in range(40, 50)
    assert details.title == f"Point {number}"
    return Details("Point of ten", details.values)


def invisible_points_do_not_count(bench: Benches) -> Details:
    """An rgba with alpha 0 hides the first."""
    names = [*XYZ, ("rgba", 12, UINT32, 1)]
    points = [
        {"x": [1.0], "y": [0.0], "z": [0.0], "rgba": [0x00FF0000]},
        {"x": [2.0], "y": [0.0], "z": [0.0], "rgba": [0xFF00FF00]},
    ]
    at = bench(PointCloud2())
    at.transform("map", "lidar")
    at.send(CLOUD, cloud(names, points), frame="lidar")
    at.turn()
    return pick(at, "points", 0)


def object_of_a_planning_scene(bench: Benches) -> Details:
    """The coloured one, drawn by itself, as its opacity differs."""
    at = bench(PlanningScene())
    moveit(at)
    return pick(at, "object box 0.502", 0)


def what_a_robot_holds(bench: Benches) -> Details:
    at = bench(RobotState())
    moveit(at)
    return pick(at, "attached box", 0)


def link_on_a_path(bench: Benches) -> Details:
    at = bench(Trajectory(paused=True))
    moveit(at)
    return pick(at, "path rider visual visual_0", None, (0.0, 0.0, 0.0))


def link_of_a_trail(bench: Benches) -> Details:
    at = bench(Trajectory(paused=True, show_trail=True))
    moveit(at)
    return pick(at, "trail rider visual visual_0 0", 2)


def link_of_a_solution(bench: Benches) -> Details:
    at = bench(MotionPlanningTasks(paused=True))
    plan_task(at)
    return pick(at, "path rider visual visual_0", None, (0.0, 0.0, 0.0))


def marker_of_a_solution(bench: Benches) -> Details:
    at = bench(MotionPlanningTasks(paused=True))
    plan_task(at)
    return pick(at, "box in 0", 0)


def beam_of_a_scan(bench: Benches) -> Details:
    at = bench(LaserScan())
    at.transform("map", "laser")
    scan = {"angle_min": -0.5, "angle_increment": 0.25, "range_min": 0.1, "range_max": 10.0}
    ranges = {"ranges": [NAN, 2.3, math.inf, 0.7, 20.0], "intensities": [1, 2, 3, 4.2, 5]}
    at.send("sensor_msgs/msg/LaserScan", scan | ranges, frame="laser")
    at.turn()
    return pick(at, "points", 1)


def cell_of_a_map(bench: Benches) -> Details:
    """In the second tile of a turned map."""
    cells = np.zeros((3, 600), np.int8)
    cells[1, 520] = 100
    info = {
        "resolution": 0.5,
        "width": 600,
        "height": 3,
        "origin": {"position": {"x": 10.0}, "orientation": {"z": QUARTER[2], "w": QUARTER[3]}},
    }
    at = bench(Map())
    at.send("nav_msgs/msg/OccupancyGrid", {"info": info, "data": cells.ravel()}, frame="map")
    at.turn()
    return pick(at, "tile 0 512", None, (0.5 * (520 - 512) + 0.1, 0.6, 0.0))


def link_of_a_robot(bench: Benches) -> Details:
    at = bench(RobotModel())
    place_arm(at)
    describe(at, ARM)
    return pick(at, "base visual visual_0", None, (0.5, 0.0, 0.0))


def frame_of_a_tree(bench: Benches) -> Details:
    at = bench(TF(show_arrows=False))
    at.transform("map", "odom", (1.0, 0.0, 0.0))
    at.transform("odom", "base", (0.0, 2.0, 0.0), QUARTER, stamp_ns=at.now_ns - 500_000_000)
    at.turn()
    (number,) = np.flatnonzero(at.nodes()["axes"].ids == "base")
    return pick(at, "axes", int(number))


def pose_of_a_path(bench: Benches) -> Details:
    at = bench(Path(pose_style="Arrows"))
    at.transform("map", "odom", (10.0, 0.0, 0.0))
    places = [{"x": float(i), "y": 1.0} for i in range(3)]
    poses = [
        {"header": {"stamp": {"sec": 7 + i}}, "pose": {"position": place}}
        for i, place in enumerate(places)
    ]
    at.send("nav_msgs/msg/Path", {"poses": poses}, frame="odom")
    at.turn()
    assert pick(at, "line", 1) == pick(at, "poses", 1)
    return pick(at, "poses", 2)


def odometry_with_covariance(bench: Benches) -> Details:
    at = bench(Odometry())
    at.transform("map", "odom")
    for x in (0.0, 1.0, 2.0):
        pose = {
            "pose": {"position": {"x": x}},
            "covariance": np.diag([0.04, 0, 0, 0, 0, 1]).ravel(),
        }
        twist = {"twist": {"linear": {"x": 0.5}, "angular": {"z": -0.25}}}
        message = {"child_frame_id": "base", "pose": pose, "twist": twist}
        at.send("nav_msgs/msg/Odometry", message, frame="odom")
        at.turn()
    assert pick(at, "ellipses", 1) == pick(at, "poses", 1)
    return pick(at, "poses", 1)


def one_of(
    bench: Benches,
    display: Display,
    type_name: str,
    values: Mapping[str, Any],
    key: str,
    number: int | None,
    point: Any = None,
) -> Details:
    """An item of a node of a message in the frame odom."""
    at = bench(display)
    at.transform("map", "odom", (10.0, 0.0, 0.0), QUARTER)
    at.send(type_name, values, frame="odom")
    at.turn()
    return pick(at, key, number, point)


POSE = {"position": {"x": 1.0, "y": 2.0}, "orientation": {"w": 1.0}}


def pose(bench: Benches) -> Details:
    return one_of(bench, Pose(), "geometry_msgs/msg/PoseStamped", {"pose": POSE}, "poses", 0)


def pose_with_covariance(bench: Benches) -> Details:
    values = {"pose": {"pose": POSE, "covariance": np.diag([0.04, 0, 0, 0, 0, 1]).ravel()}}
    type_name = "geometry_msgs/msg/PoseWithCovarianceStamped"
    return one_of(bench, PoseWithCovariance(), type_name, values, "ellipses", 0)


def pose_of_an_array(bench: Benches) -> Details:
    """The last line of the second arrow."""
    values = {"poses": [{"position": {"x": NAN}}, POSE]}
    return one_of(bench, PoseArray(), "geometry_msgs/msg/PoseArray", values, "poses", 2)


def particle(bench: Benches) -> Details:
    """The y axis of the second."""
    values = {"particles": [{"pose": POSE, "weight": w} for w in (0.25, 0.75)]}
    cloud = ParticleCloud(shape="Axes")
    return one_of(bench, cloud, "nav2_msgs/msg/ParticleCloud", values, "poses", 4)


def point(bench: Benches) -> Details:
    values = {"point": {"x": 1.0, "y": 2.5}}
    return one_of(bench, PointStamped(), "geometry_msgs/msg/PointStamped", values, "points", 0)


def last_side_of_a_polygon(bench: Benches) -> Details:
    points = np.array([(0, 0, 0), (3, 0, 0), (3, 4, 0)], np.float32)
    values = {"polygon": {"points": points}}
    return one_of(bench, Polygon(), "geometry_msgs/msg/PolygonStamped", values, "outline", 2)


def cell_of_a_grid(bench: Benches) -> Details:
    cells = np.array([(NAN, 0, 0), (0, 0, 0), (1, 0, 0)], np.float64)
    values = {"cell_width": 1.0, "cell_height": 0.5, "cells": cells}
    clicked = (1.25, 0.125, 0.0)
    return one_of(bench, GridCells(), "nav_msgs/msg/GridCells", values, "cells", None, clicked)


def voxel_of_an_octree(bench: Benches) -> Details:
    """The one on top, which is the last along the curve through the tree."""
    at = bench(ColorOccupancyGrid())
    at.transform("map", "odom")
    at.send(OCTOMAP, hill("ColorOcTree"), frame="odom")
    at.turn()
    return pick(at, "voxels", 4)


def cell_of_a_grid_map(bench: Benches) -> Details:
    """Rows are along -x."""
    layers = {"elevation": lambda x, y: x, "variance": lambda x, y: 0.25}
    values = grid_map(layers, (3, 4), 0.5, (1, 2))
    return one_of(bench, GridMap(), GRID_MAP, values, "surface", None, (0.4, -0.7, 0.5))


def pixel_of_a_depth_image(bench: Benches) -> Details:
    """The third column and the second row from the top, of 4 x 3 pixels that are 0.5 m large."""
    at = bench(ImagePlane(plane="XY", width=2.0))
    depths = np.arange(12, dtype=np.float32).reshape(3, 4) / 4
    at.send(photos.RAW, photos.raw(depths, "32FC1"), frame="map")
    at.turn()
    at.settle()
    return pick(at, "image", None, (1.2, 0.6, 0.0))


def voxel_of_a_costmap(bench: Benches) -> Details:
    return one_of(bench, VoxelGrid(), "nav2_msgs/msg/VoxelGrid", VOXEL_GRID, "marked", 1)


def link_of_a_graph(bench: Benches) -> Details:
    return one_of(bench, MapGraph(), "rtabmap_msgs/msg/MapGraph", GRAPH, "links", 3)


def voxel_of_nvblox(bench: Benches) -> Details:
    type_name = "nvblox_msgs/msg/VoxelBlockLayer"
    return one_of(bench, NvbloxVoxelBlockLayer(), type_name, VOXELS, "region 0 0 0", 1)


def surface_of_nvblox(bench: Benches) -> Details:
    at = bench(NvbloxMesh())
    at.send("nvblox_msgs/msg/Mesh", MESH, frame="map", topic="/nvblox_node/mesh")
    at.turn()
    return pick(at, "region 0 0 0", None, (0.1, 0.1, 0.1))


def point_of_a_map(bench: Benches) -> Details:
    """The second of the second node; the first has left the graph."""
    at = bench(MapCloud(cloud_from_scan=True))
    data = {id: scanned(*SCAN) for id in (3, 5)}
    for places in ({3: (0.0, 0.0), 5: (1.0, 0.0)}, {5: (1.0, 0.0)}):
        at.send(MAP_DATA, map_data(places, data), frame="map", topic="/rtabmap/mapData")
        at.turn()
    return pick(at, "points", 1)


def point_of_a_trajectory(bench: Benches) -> Details:
    return one_of(bench, AutowareTrajectory(), TRAJECTORY, TIMED, "velocity line", 2)


def pose_of_a_history(bench: Benches) -> Details:
    at = bench(PoseHistory())
    for values in PASSED:
        at.send(POSE_STAMPED, values, frame="map")
        at.turn(0.1)
    return pick(at, "line", 1)


def pedestrian_of_autoware(bench: Benches) -> Details:
    return one_of(bench, TrackedObjects(), TRACKED, FOLLOWED, "shapes", 30)


def car_of_a_zed_camera(bench: Benches) -> Details:
    return one_of(bench, ZedOdDisplay(), ZED_OBJECTS, ZED_SCENE, "boxes", 3)


def cell_of_a_costmap(bench: Benches) -> Details:
    at = bench(Costmap())
    at.send("nav2_msgs/msg/Costmap", COSTMAP, frame="map", topic="/local_costmap/costmap_raw")
    at.turn()
    return pick(at, "tile 0 0", None, (0.6, 0.6, 0.0))


def inertial_sensor(bench: Benches) -> Details:
    return one_of(bench, Imu(), "sensor_msgs/msg/Imu", IMU, "axes", 0)


def magnetic_field(bench: Benches) -> Details:
    return one_of(bench, Mag(), "sensor_msgs/msg/MagneticField", FIELD, "heads", 0)


def torque(bench: Benches) -> Details:
    values = {"wrench": {"force": {"x": 1.5}, "torque": {"z": -2.0}}}
    type_name = "geometry_msgs/msg/WrenchStamped"
    return one_of(bench, Wrench(), type_name, values, "torque circles", 5)


def effort_of_a_joint(bench: Benches) -> Details:
    at = bench(Effort())
    urdf = (
        "<robot name='r'><link name='map'/><link name='odom'/><joint name='elbow' type='revolute'>"
        "<parent link='map'/><child link='odom'/><limit effort='8' velocity='1'/></joint></robot>"
    )
    at.send("std_msgs/msg/String", {"data": urdf}, topic="/robot_description")
    at.turn()
    at.settle()
    at.transform("map", "odom")
    values = {"name": ["elbow"], "effort": [2.0]}
    at.send("sensor_msgs/msg/JointState", values, frame="", topic="/joint_states")
    at.turn()
    return pick(at, "rings", 3)


def cone_of_a_range(bench: Benches) -> Details:
    values = {"radiation_type": 1, "field_of_view": 0.5, "max_range": 4.0, "range": 0.7}
    return one_of(bench, Range(), "sensor_msgs/msg/Range", values, "cone", 0)


def temperature(bench: Benches) -> Details:
    values = {"temperature": 21.5, "variance": 0.25}
    return one_of(bench, Temperature(), "sensor_msgs/msg/Temperature", values, "points", 0)


def point_of_an_older_cloud(bench: Benches) -> Details:
    channels = [{"name": "ring", "values": [3.0, 5.0]}]
    values = {"points": np.array([(NAN, 0, 0), (1, 2, 3)], np.float32), "channels": channels}
    cloud = PointCloud(color_transformer="FlatColor")
    return one_of(bench, cloud, "sensor_msgs/msg/PointCloud", values, "points", 0)


def marker(
    bench: Benches, key: str, number: int | None, point: Any = None, **fields: Any
) -> Details:
    """An item of the second of two markers, 10 m behind the first."""
    each = {"scale": {"x": 1.0, "y": 1.0, "z": 1.0}, "color": {"g": 1.0, "a": 1.0}, **fields}
    header = {"frame_id": "odom"}
    near, far = ({"pose": {"position": {"x": x}}} for x in (0.0, 10.0))
    markers = [{**each, **pose, "header": header, "ns": "a", "id": i}
               for i, pose in enumerate((near, far))]  # fmt: skip
    at = bench(MarkerArray())
    at.transform("map", "odom")
    at.send("visualization_msgs/msg/MarkerArray", {"markers": markers})
    at.turn()
    at.settle()
    (found,) = (name for name in at.nodes() if name.startswith(key))
    return pick(at, found, number, point)


def shape_of_a_marker(bench: Benches) -> Details:
    return marker(bench, "box", 1, type=1)


def point_of_a_marker(bench: Benches) -> Details:
    return marker(bench, "points", 4, type=8, points=np.arange(9.0).reshape(3, 3))


def line_of_a_marker(bench: Benches) -> Details:
    return marker(bench, "lines", 3, type=4, points=np.arange(9.0).reshape(3, 3))


TRIANGLES = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 0, 1), (0, 0, 2)], np.float64)


def triangle_of_a_marker(bench: Benches) -> Details:
    """One of two that are one mesh; they have a triangle without an area too."""
    return marker(bench, "triangles", None, (10.2, 0.3, 0.0), type=11, points=TRIANGLES)


def triangle_of_a_colorful_marker(bench: Benches) -> Details:
    colors = np.array([(1, 0, 0, 1)] * 6, np.float32)
    more = {"type": 11, "points": TRIANGLES, "colors": colors}
    return marker(bench, "colorful", None, (10.2, 0.3, 0.0), **more)


def texture_of_a_marker(bench: Benches) -> Details:
    png = io.BytesIO()
    PIL.Image.new("RGB", (2, 2)).save(png, "png")
    texture = {"format": "png", "data": png.getvalue()}
    uvs = np.zeros((6, 2), np.float32)
    more = {"texture_resource": "embedded://a.png", "texture": texture, "uv_coordinates": uvs}
    return marker(bench, "triangles 2", None, (10.2, 0.3, 0.0), type=11, points=TRIANGLES, **more)


def text_of_a_marker(bench: Benches) -> Details:
    return marker(bench, "texts", 1, type=9, text="Dock")


def grid(bench: Benches) -> Details:
    at = bench(Grid(plane_cell_count=4, cell_size=0.5))
    at.turn()
    return pick(at, "grid", 3)


def axes(bench: Benches) -> Details:
    at = bench(Axes(reference_frame="odom"))
    at.transform("map", "odom", (1.0, 0.0, 0.0))
    at.turn()
    return pick(at, "axes", 0)


class Unaware(Display):
    """A display that does not know of selections."""

    def draw_all(self, samples: object, ctx: Context) -> None:
        rows = [[(0, 0, 0), (1, 0, 0)], [(NAN, 0, 0), (1, 0, 0)], [(0, 1, 0), (1, 1, 0)]]
        ctx.lines("lines", rows, (0, 0, 0))


def line_of_a_display_that_does_not_know(bench: Benches) -> Details:
    """The second in the browser, which does not get the one that is not finite."""
    at = bench(Unaware())
    at.turn()
    (name,) = at.scene.groups
    assert isinstance(at.nodes()["lines"], Lines)
    found = at.runner.find(Picks(name, "lines", ((1, 1, (0.0, 1.0, 0.0), None),)))
    details = at.runner.inspect(found[1], Frames(at.buffer, "map", 0))
    return details


POSE_TOLD = {
    "fields": {
        "Position": "1.0000, 2.0000, 0.0000 m",
        "Orientation": "x 0.0000, y 0.0000, z 0.0000, w 1.0000",
        "Roll, pitch, yaw": "0.00, 0.00, 0.00 °",
    }
}
CASES: dict[Callable[[Benches], Details], tuple[str, Mapping[str, Any]]] = {
    point_of_a_cloud: (
        "Point 5",
        {"intensity": "0.5", "rgb": "r 1, g 2, b 8", "ring": "5, 10", "Row": "1", "Column": "2",
         "Position in lidar": {"fields": {"x": "7.0", "y": "8.0", "z": "0.1"}}},
    ),
    point_of_a_thinned_cloud: ("Point of ten", {"Points in the cloud": "100"}),
    invisible_points_do_not_count: ("Point 1", {"rgba": "r 0, g 255, b 0, a 255"}),
    beam_of_a_scan: (
        "Beam 3",
        {"Range": "0.7 m", "Intensity": "4.2", "Angle": "0.250000 rad, 14.32°",
         "Beams in the scan": "5"},
    ),
    cell_of_a_map: (
        "Cell 520, 1",
        {"Value": "100, occupied", "Column (x)": "520", "Row (y)": "1", "Index": "1120",
         "Center in map": "9.2500, 260.2500, 0.0000 m"},
    ),
    link_of_a_robot: (
        "Link base",
        {"Mass": "6 kg", "Visual": "a box, sphere or cylinder", "Robot": "arm",
         "Parent frame": "map"},
    ),
    frame_of_a_tree: ("Frame base", {"Parent": "odom", "Age": "0.50 s"}),
    pose_of_a_path: ("Pose 2", {"Poses in the path": "3", "Stamp of the pose": "9.000000 s"}),
    odometry_with_covariance: (
        "Odometry 1",
        {"Speed": "0.5, 0, 0 m/s", "Turn rate": "0, 0, -0.25 rad/s", "Child frame": "base",
         "Standard deviations": "x 0.2, y 0, z 0, roll 0, pitch 0, yaw 1"},
    ),
    pose: ("Pose 0", {"Pose in odom": POSE_TOLD}),
    pose_with_covariance: (
        "Pose 0",
        {"Pose in odom": POSE_TOLD,
         "Standard deviations": "x 0.2, y 0, z 0, roll 0, pitch 0, yaw 1"},
    ),
    pose_of_an_array: ("Pose 1", {"Pose in odom": POSE_TOLD, "Poses in the message": "2"}),
    particle: ("Particle 1", {"Weight": "0.75", "Particles in the message": "2"}),
    point: ("Point 0", {"Point in odom": {"fields": {"x": "1", "y": "2.5", "z": "0"}}}),
    last_side_of_a_polygon: ("Side 2", {"Length": "5 m", "Points in the polygon": "3"}),
    cell_of_a_grid: ("Cell 2", {"Size": "1 m x 0.5 m", "Cells in the message": "3"}),
    pixel_of_a_depth_image: ("Pixel 2, 1", {"Value": "1.5"}),
    voxel_of_an_octree: (
        "Occupied voxel",
        {"Occupancy": "62.2%", "Log-odds": "0.5", "Size": "0.5 m", "Depth": "16",
         "Color": "r 0, g 255, b 0"},
    ),
    cell_of_a_grid_map: (
        "Cell 0, 3", {"elevation": "0.5", "variance": "0.25", "Size of a cell": "0.5 m"}
    ),
    voxel_of_a_costmap: ("Voxel 0, 0, 1", {"State": "marked"}),
    link_of_a_graph: ("Link 1 to 3", {"Type": "2, local loop closure"}),
    voxel_of_nvblox: ("Voxel", {"Edge": "0.1 m"}),
    surface_of_nvblox: ("Mesh", {}),
    point_of_a_map: (
        "Point of node 5", {"Seen": "500.000 s", "Points of the node": "3", "Intensity": "90.0"}
    ),
    point_of_a_trajectory: (
        "Point 2 of 4",
        {"Velocity": "2 m/s", "Lateral velocity": "0.25 m/s", "Heading rate": "0.125 rad/s",
         "Time": "0.5 s", "Acceleration": "0.5 m/s²", "Front wheels": "0 rad"},
    ),
    pose_of_a_history: ("Pose 1", {}),
    pedestrian_of_autoware: (
        "PEDESTRIAN 1111",
        {"Probability": "75 %", "Size": "0.5 x 0.5 x 1 m", "Speed": "2.00 m/s", "Id": "11" * 16},
    ),
    car_of_a_zed_camera: (
        "3-Vehicle [Car]",
        {"Kind": "Vehicle > Car", "Confidence": "87.5 %", "Velocity": "1.5, 0, 0 m/s",
         "Size": "0.8 x 0.4 x 0.5 m", "Tracking": "tracked"},
    ),
    cell_of_a_costmap: ("Cell 1, 1", {"Value": "254, lethal"}),
    inertial_sensor: (
        "Inertial sensor",
        {"Orientation": "x 0.0000, y 0.0000, z 0.6000, w 0.8000",
         "Acceleration in odom": "1, 0, 9 m/s²"},
    ),
    magnetic_field: ("Magnetic field", {"Field in odom": "2e-05, 1e-05, -4e-05 T"}),
    torque: ("Wrench 0", {"Force in odom": "1.5, 0, 0 N", "Torque in odom": "0, 0, -2 Nm"}),
    effort_of_a_joint: (
        "Joint elbow", {"Effort": "2 Nm", "Largest effort": "8 Nm", "Link": "odom"}
    ),
    cone_of_a_range: (
        "Range 0",
        {"Range": "0.7 m", "Field of view": "28.65°", "Limits": "0 to 4 m",
         "Radiation": "infrared"},
    ),
    temperature: ("Temperature 0", {"Value": "21.5 °C", "Standard deviation": "0.5 °C"}),
    point_of_an_older_cloud: ("Point 1", {"ring": "5.0", "Points in the cloud": "2"}),
    shape_of_a_marker: (
        "Marker a/1", {"Namespace": "a", "Id": "1", "Type": "CUBE", "Frame": "odom"}
    ),
    point_of_a_marker: ("Marker a/1", {"Type": "POINTS", "Points": "3"}),
    line_of_a_marker: ("Marker a/1", {"Type": "LINE_STRIP", "Age": "0.0 s"}),
    triangle_of_a_marker: ("Marker a/1", {"Type": "TRIANGLE_LIST", "Points": "6"}),
    triangle_of_a_colorful_marker: ("Marker a/1", {"Type": "TRIANGLE_LIST"}),
    texture_of_a_marker: ("Marker a/1", {"Type": "TRIANGLE_LIST"}),
    text_of_a_marker: ("Marker a/1", {"Type": "TEXT_VIEW_FACING", "Text": "Dock"}),
    object_of_a_planning_scene: ("Object 'door'", {"Shapes": "1 box"}),
    what_a_robot_holds: ("Object 'cup'", {"Attached to": "rider", "Shapes": "1 box"}),
    link_on_a_path: (
        "Link rider", {"Point": "Point 4 of 4 points, at 3000.00 s", "Robot": "rail"}
    ),
    link_of_a_solution: (
        "Link rider", {"Point": "Point 8 of 8 points, at 6000.00 s", "Robot": "rail"}
    ),
    marker_of_a_solution: ("Marker far/0", {"Type": "CUBE"}),
    link_of_a_trail: ("Link rider", {"Point": "3"}),
    grid: ("Grid", {"Cell size": "0.5 m", "Cells": "4 x 4", "Plane": "XY"}),
    axes: ("Axes of odom", {"Length": "1 m"}),
    line_of_a_display_that_does_not_know: ("Line 2", {}),
}  # fmt: skip


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.__name__)
def test_a_display_answers_what_was_selected(
    bench: Benches, case: Callable[[Benches], Details]
) -> None:
    title, values = CASES[case]
    details = case(bench)
    assert details.title == title
    told = details_tree(details.values)["fields"]
    assert {name: told.get(name) for name in values} == values
