"""Displays of poses, areas, vectors, measurements and markers draw what comes over DDS."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from autoware_scenes import AUTOWARE_MESSAGES
from mapping_scenes import MAPPING_MESSAGES
from moveit_scenes import MOVEIT_MESSAGES, URDF
from perception_scenes import PERCEPTION_MESSAGES
from plain_scenes import PLAIN_MESSAGES, ROBOT
from rtabmap_scenes import RTABMAP_MESSAGES

from webviz import Display, Level, Topic
from webviz.api.display import inputs, inputs_of
from webviz.data.messages import encode
from webviz.shell.testing import LiveViewer
from webviz_displays.areas import GridCells, Polygon
from webviz_displays.autoware import (
    AutowarePath,
    AutowareTrajectory,
    DetectedObjects,
    PredictedObjects,
    TrackedObjects,
)
from webviz_displays.grid_map import GridMap
from webviz_displays.imu import Imu, Mag
from webviz_displays.map import Costmap
from webviz_displays.map_cloud import MapCloud
from webviz_displays.map_graph import MapGraph
from webviz_displays.markers import Marker, MarkerArray
from webviz_displays.moveit import PlanningScene, RobotState, Trajectory
from webviz_displays.nvblox import NvbloxMesh, NvbloxVoxelBlockLayer
from webviz_displays.octomap import OccupancyGrid, OccupancyMap
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

pytest.importorskip("rclpy", reason="a live viewer needs rclpy")

CLASSES: tuple[type[Display], ...] = (
    *(ParticleCloud, PointStamped, Pose, PoseArray, PoseWithCovariance, GridCells, Polygon),
    *(FluidPressure, Illuminance, PointCloud, Range, RelativeHumidity, Temperature),
    *(AccelStamped, Effort, TwistStamped, Wrench),
    *(OccupancyGrid, OccupancyMap, GridMap, VoxelGrid, Costmap, Imu, Mag),
    *(MapCloud, MapGraph, NvbloxMesh, NvbloxVoxelBlockLayer),
    *(ZedOdDisplay, AutowarePath, AutowareTrajectory),
    *(DetectedObjects, TrackedObjects, PredictedObjects),
)
MESSAGES = (
    PLAIN_MESSAGES | MAPPING_MESSAGES | AUTOWARE_MESSAGES | PERCEPTION_MESSAGES | RTABMAP_MESSAGES
)


def test_each_display_draws_published_messages_and_is_ok(
    webviz_viewer: Callable[..., LiveViewer],
) -> None:
    """Types without a package, such as nav2's, are composed."""
    displays = [cls() for cls in CLASSES]
    viewer = webviz_viewer(*displays, Twist(reference_frame="sensor"))
    viewer.transform("map", "sensor")
    viewer.transform("map", "rider")
    text = "std_msgs/msg/String"
    viewer.publish_bytes("/robot_description", text, encode(text, {"data": ROBOT}), latched=True)
    viewer.publish("/cmd_vel", "geometry_msgs/msg/Twist", PLAIN_MESSAGES["geometry_msgs/msg/Twist"])
    types = {
        inputs(display)[0][2].name: next(iter(inputs_of(type(display)).values())).type
        for display in displays
    }
    for topic, type_name in types.items():  # a second each, one after another
        viewer.advertise(topic, type_name)
    for topic, type_name in types.items():
        viewer.publish(topic, type_name, MESSAGES.get(type_name, {}), frame="sensor")
    for cls in (*CLASSES, Twist):
        viewer.wait_until_drawn(cls.__name__)
        status = viewer.status(cls.__name__)
        assert status.level is Level.OK, f"{cls.__name__}: {status.text}"


def test_types_of_moveit_need_no_package(webviz_viewer: Callable[..., LiveViewer]) -> None:
    displays = PlanningScene(), Trajectory(), RobotState()
    viewer = webviz_viewer(*displays)
    viewer.transform("map", "base")
    text = "std_msgs/msg/String"
    viewer.publish_bytes("/robot_description", text, encode(text, {"data": URDF}), latched=True)
    for display in displays:
        name, spec = next(iter(inputs_of(type(display)).items()))
        topic = f"/{getattr(display, name).name.removeprefix('/')}"
        viewer.publish(topic, spec.type, MOVEIT_MESSAGES[spec.type])
        viewer.wait_until_drawn(type(display).__name__)
        status = viewer.status(type(display).__name__)
        assert status.level is Level.OK, status.text


def cube(id: int, frame: str = "map", alpha: float = 1.0, **more: Any) -> dict[str, Any]:
    """A cube of 1 m at the latest transform."""
    values = {
        "header": {"frame_id": frame},
        "ns": "cubes",
        "id": id,
        "type": 1,
        "scale": {"x": 1.0, "y": 1.0, "z": 1.0},
        "color": {"r": 1.0, "a": alpha},
    }
    return values | more


def test_markers_come_go_wait_and_expire(webviz_viewer: Callable[..., LiveViewer]) -> None:
    viewer = webviz_viewer(Marker(), MarkerArray(topic=Topic("/shapes")))

    def send(*markers: dict[str, Any], topic: str = "/visualization_marker_array") -> None:
        viewer.publish(topic, "visualization_msgs/msg/MarkerArray", {"markers": markers})

    def says(text: str, key: str = "Markers", display: int = 0) -> None:
        def statuses() -> str:
            rows = viewer.viewer.snapshot().rows
            return str({key: each.text for key, each in rows[display].statuses.items()})

        def status_text() -> str:
            status = viewer.viewer.snapshot().rows[display].statuses.get(key)
            return status.text if status else ""

        viewer.wait_for(lambda: text in status_text(), statuses)

    viewer.publish("/visualization_marker", "visualization_msgs/msg/Marker", cube(1))
    says("1 marker in 1 namespace.")
    send(cube(2), cube(3, "late"))
    says("2 of 3 markers shown in 1 namespace; 1 waiting for a transform.")
    says("late", "Transform")
    viewer.transform("map", "late", (5.0, 0.0, 0.0))
    says("3 markers in 1 namespace.")
    send(cube(1, action=2), cube(2, ns="others"))
    says("3 markers in 2 namespaces.")
    send(cube(0, ns="", action=3), cube(4), cube(5, alpha=0.0))
    says("1 of 2 markers shown in 1 namespace.")
    says("alpha of the color is 0", "Marker cubes/5")
    send(cube(0, action=3), cube(6, lifetime={"nanosec": 300_000_000}))
    says("The last one, cubes/6, expired")

    viewer.transform("map", "late", (5.0, 0.0, 0.0))
    send(cube(1, "late"), cube(1, "late"), topic="/shapes")
    says("1 marker in 1 namespace.", display=1)
    says("cubes/1", "Duplicates", display=1)
